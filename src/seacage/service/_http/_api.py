"""The service as one ASGI application: its cages, its doors and its page."""

import asyncio
from collections.abc import AsyncGenerator, Callable, Coroutine, Mapping, Sequence
from contextlib import asynccontextmanager
from importlib.metadata import version
from pathlib import Path

import structlog
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, PlainTextResponse, Response
from fastapi.staticfiles import StaticFiles
from starlette.middleware.gzip import DEFAULT_EXCLUDED_CONTENT_TYPES, GZipMiddleware
from starlette.routing import Match, Mount
from starlette.types import Scope

from seacage.conventions import InputError
from seacage.service._auth._audit import Audit
from seacage.service._auth._authorization import Gate
from seacage.service._auth._limits import Limits
from seacage.service._auth._shield import Shield
from seacage.service._auth._token_store import Tokens
from seacage.service._http._alarm_routes import alarms
from seacage.service._http._cage_routes import around, cages
from seacage.service._http._clearance_routes import rov
from seacage.service._http._download_routes import NETCDF, downloads
from seacage.service._http._sensorthings._routes import things
from seacage.service._http._session_routes import sessions
from seacage.service._http._websocket import sockets
from seacage.service._http._whatif_routes import what_if
from seacage.service._live._cage import LiveCage
from seacage.service._live._cage_gauges import CageGauges
from seacage.service._live._frame import MEDIA_TYPE
from seacage.service._live._metrics import Metrics
from seacage.service._rov._files import MCAP
from seacage.service._rov._ros_messages import NoRosbagsError
from seacage.service._schemas._base import with_examples
from seacage.service._store._store import Store, StoreError
from seacage.twin import StaleError

_FAULTS = 5  # of a request, as many as anyone reads
_METHODS = ("DELETE", "GET", "PATCH", "POST", "PUT")
_PACKED = 1000  # the shortest answer that is worth it to compress [bytes]
# What is packed already, or short and frequent
_UNPACKED = (*DEFAULT_EXCLUDED_CONTENT_TYPES, MEDIA_TYPE, NETCDF, MCAP)
_log = structlog.get_logger(__name__)
# Where the build puts them; it is not there where no page was built
PAGE = Path(__file__).parents[1] / "page"
_FOR_EVER = "public, max-age=31536000, immutable"


class Service:
    """What the doors open to, and the work that goes on behind them."""

    def __init__(
        self,
        *,
        cages: Mapping[str, LiveCage],  # by name
        # Shared by all cages
        store: Store,
        tokens: Tokens,
        metrics: Metrics,
        # What runs beside the cages, such as a replay
        feeds: Sequence[Callable[[], Coroutine[None, None, None]]] = (),
        # How much one asker may ask, where the cages lie, and where it is written who did what
        limits: Limits | None = None,
        site: str = "",
        audit: Audit | None = None,
    ) -> None:
        self.cages, self.store, self.tokens, self.metrics = cages, store, tokens, metrics
        self.gate = Gate(tokens, metrics=metrics, limits=limits, audit=audit, site=site)
        metrics.damaged.set_function(lambda: float(store.damage.count))
        metrics.unverified.set_function(lambda: float(store.damage.unverified))
        metrics.ready.set_function(lambda: float(self.trouble() is None))
        metrics.registry.register(CageGauges(cages))
        self._feeds = feeds
        self._tasks: list[asyncio.Task[None]] = []

    def begin(self) -> None:
        """Set every cage and feed to work."""
        work = {f"cage {name}": one.run() for name, one in self.cages.items()}
        work |= {f"feed {number}": feed() for number, feed in enumerate(self._feeds, start=1)}
        for name, task in work.items():
            self._tasks.append(asyncio.create_task(task, name=name))
            self._tasks[-1].add_done_callback(_mourn)

    async def end(self) -> None:
        """Stop the work and close the store."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await asyncio.to_thread(self.store.close)

    def trouble(self) -> str | None:
        """Say why the service cannot do its work; None while it can."""
        stopped = [task.get_name() for task in self._tasks if task.done()]
        if stopped:
            return f"{stopped[0]} has stopped; see the log and start the service anew."
        return self.store.fault


def _mourn(task: asyncio.Task[None]) -> None:
    if not task.cancelled() and (error := task.exception()):
        _log.error("stopped", task=task.get_name(), exc_info=error)


class PageFiles(StaticFiles):
    """Files of the page: those whose names hold a hash of their content never change."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        answer = await super().get_response(path, scope)
        if "etag" in answer.headers:  # weak, as a compressed file is not the same bytes
            answer.headers["etag"] = f"W/{answer.headers['etag'].removeprefix('W/')}"
        if path.startswith("assets/") and answer.status_code == 200:
            answer.headers["cache-control"] = _FOR_EVER
        return answer


def create_app(service: Service) -> FastAPI:
    """Build the application that uvicorn runs."""

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncGenerator[None]:
        service.begin()
        yield
        await service.end()

    app = FastAPI(
        title="seacage",
        version=version("seacage"),
        summary="Loads and shape of net cages, live, with their uncertainty.",
        lifespan=lifespan,
        docs_url=None,  # their pages load scripts from elsewhere
        redoc_url=None,
        openapi_url=None,  # its own call asks for a token from elsewhere
    )
    app.state.service = service
    app.add_middleware(
        GZipMiddleware, minimum_size=_PACKED, compresslevel=5, exclude_content_types=_UNPACKED
    )
    app.add_middleware(Shield)
    app.add_exception_handler(InputError, _answer(422))
    app.add_exception_handler(StaleError, _answer(409))
    app.add_exception_handler(StoreError, _answer(503, {"Retry-After": "5"}))
    app.add_exception_handler(NoRosbagsError, _answer(501))
    app.add_exception_handler(RequestValidationError, _validation_error)
    app.add_exception_handler(405, _other_methods)
    for router in (around, sessions, cages, alarms, what_if, downloads, rov, things, sockets):
        app.include_router(router)
    described = app.openapi
    app.openapi = lambda: with_examples(described())
    if PAGE.is_dir():
        app.mount("/page", PageFiles(directory=PAGE), name="page")
    app.add_api_route("/", _page, include_in_schema=False)
    return app


async def _page(request: Request) -> Response:
    if (PAGE / "index.html").is_file():
        return await PageFiles(directory=PAGE).get_response("index.html", request.scope)
    return PlainTextResponse(
        "The page is not built here: run `make page`, or install a wheel, which brings it. "
        "The interface is described at /openapi.json.\n",
        status_code=404,
    )


def _answer(
    status: int, headers: dict[str, str] | None = None
) -> Callable[[Request, Exception], JSONResponse]:
    """Answer an error by its message."""
    return lambda _, error: JSONResponse({"detail": str(error)}, status, headers)


def _other_methods(request: Request, _: Exception) -> JSONResponse:
    """Name the methods of all calls of a path, of which each is a route of its own."""
    calls = [one for one in request.app.routes if not isinstance(one, Mount)]  # of files
    scope = {name: {**request.scope, "method": name} for name in _METHODS}
    methods = [
        name for name in _METHODS if any(one.matches(scope[name])[0] == Match.FULL for one in calls)
    ]
    detail = f"This path does not take {request.method}."
    return JSONResponse({"detail": detail}, 405, {"Allow": ", ".join(methods or ["GET"])})


def _validation_error(_: Request, error: Exception) -> JSONResponse:
    assert isinstance(error, RequestValidationError)
    faults = [
        f"{'.'.join(map(str, fault['loc'][1:])) or 'body'}: {fault['msg']}."
        for fault in error.errors()[:_FAULTS]
    ]
    # A key that was sent may hold half a character, which no answer can.
    sentence = " ".join(faults).encode("utf-8", "backslashreplace").decode()
    return JSONResponse({"detail": sentence}, status_code=422)
