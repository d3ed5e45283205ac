"""The page's files: those whose names hold a hash of what is in them never change."""

from pathlib import Path

from fastapi.staticfiles import StaticFiles
from starlette.responses import Response
from starlette.types import Scope

PAGE = Path(__file__).parents[1] / "page"
"""Where the build puts them; it is not there where no page was built."""

_FOR_EVER = "public, max-age=31536000, immutable"


class PageFiles(StaticFiles):
    """Files of the page, of which a browser asks the unchanging ones only once."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Answer with a file."""
        answer = await super().get_response(path, scope)
        if "etag" in answer.headers:  # weak, as a compressed file is not the same bytes
            answer.headers["etag"] = f"W/{answer.headers['etag'].removeprefix('W/')}"
        if path.startswith("assets/") and answer.status_code == 200:
            answer.headers["cache-control"] = _FOR_EVER
        return answer
