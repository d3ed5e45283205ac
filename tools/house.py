"""Counts what makes the code hard to read, and fails where a count is above its ceiling; `python
tools/house.py where` prints each place. A ceiling falls with its count, and never rises, but for
that on lines of code: what adds a capability raises it, in its own commit, by its own lines.
"""

import ast
import re
import sys
from collections import Counter, defaultdict
from io import StringIO
from pathlib import Path
from tokenize import COMMENT, DEDENT, ENDMARKER, INDENT, NEWLINE, NL, generate_tokens

ROOT = Path(__file__).parents[1]
SRC, WEB = ROOT / "src/seacage", ROOT / "web/src"
NO_CODE = {COMMENT, DEDENT, ENDMARKER, INDENT, NEWLINE, NL}
MODULES = {"twin": 20, "surrogates": 11, "studies": 15, "dynamics": 4, "service/_store": 16}
CEILINGS = {
    "names with a word of our own": 0,
    "prose with a word of our own": 0,
    "functions named by a participle": 34,
    "classes of the rename table": 0,
    "classes twice in a room": 0,
    "modules too many in a folder": 0,
    "lines of code": 45_020,
}
OWN = "said|told|tell|unsaid|heard|unheard|lessons?|taught|judged|doubt|asked"
PROSE = re.compile(r"\b(lessons?|taught|judged|heard|doubt)\b", re.IGNORECASE)
RENAMED = re.compile(
    "_?(Suspicion|Explanation|Belief|Usual|Expected|Sense|Block|Happened|Number|Herald|Watch|Kept"
    "|Passage|Together|Links|Hidden|Asked)"
)
PARTICIPLE = re.compile(
    "_*(?!bed|bred|embed|exceed|feed|need|seed|shed|speed|proceed)([a-z]+ed|begun|bound|built|caught"
    "|chosen|drawn|done|driven|fed|felt|found|frozen|given|gone|held|kept|known|laid|left|lent|lost"
    "|made|met|paid|proven|risen|said|seen|sent|shown|shut|spent|spoken|struck|taken|taught|thrown"
    "|told|understood|worn|written|wound)(_|$)"
)
KEPT: frozenset[str] = frozenset({"told_h"})  # by a saved form, a wire or a setting
Found = defaultdict[str, list[str]]


def has_own_word(name: str) -> bool:
    """Whether a part of an identifier is a word of our own."""
    snake = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    return name not in KEPT and bool(re.search(rf"(^|_)({OWN})(_|$)", snake))


def count_node(node: ast.AST, owner: ast.AST, where: str, found: Found) -> None:
    """Count one node of a module's tree."""
    name = getattr(node, "name", None) or getattr(node, "arg", None)
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
        name = node.id
    if name and not isinstance(node, ast.alias | ast.keyword) and has_own_word(name):
        found["names with a word of our own"].append(f"{where} {name}")
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
        found["prose with a word of our own"] += [f"{where} {w}" for w in PROSE.findall(node.value)]
    elif isinstance(node, ast.ClassDef) and RENAMED.fullmatch(node.name):
        found["classes of the rename table"].append(f"{where} {node.name}")
    elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and PARTICIPLE.match(node.name):
        copies = ("Self", owner.name) if isinstance(owner, ast.ClassDef) else ()
        if not node.returns or ast.unparse(node.returns).strip("'\"") not in copies:
            found["functions named by a participle"].append(f"{where} {node.name}")


def count() -> Found:
    """What is counted, and where it stands."""
    found, classes, folders = Found(list), Counter[str](), Counter[str]()
    for path in [*SRC.rglob("*.py"), *SRC.rglob("*.[ch]")]:
        folders[path.parent.relative_to(SRC).as_posix()] += 1
    for path in sorted(SRC.rglob("*.py")):
        short, text = path.relative_to(SRC), path.read_text()
        tokens, tree = generate_tokens(StringIO(text).readline), ast.parse(text)
        code = {token.start[0] for token in tokens if token.type not in NO_CODE}
        for owner in ast.walk(tree):
            for node in ast.iter_child_nodes(owner):
                count_node(node, owner, f"{short}:{getattr(node, 'lineno', 0)}", found)
                if isinstance(node, ast.ClassDef):
                    classes[f"{short.parts[0]} {node.name}"] += 1
            if isinstance(owner, ast.Expr) and isinstance(owner.value, ast.Constant):
                code -= set(range(owner.lineno, (owner.end_lineno or 0) + 1))
        found["lines of code"] += [f"{short}"] * len(code)
    for path in sorted(path for kind in ("js", "svelte") for path in WEB.rglob(f"*.{kind}")):
        text = re.sub(r"//.*|/\*[\s\S]*?\*/|<!--[\s\S]*?-->", "", path.read_text())
        declared = set(re.findall(r"(?:const|let|function|class|export)\s+(\w+)", text))
        names = found["names with a word of our own"]
        names += [f"{path.name} {name}" for name in declared if has_own_word(name)]
        found["prose with a word of our own"] += [f"{path.name} {w}" for w in PROSE.findall(text)]
    for path in (*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")):  # decisions are of their time
        words = PROSE.findall(path.read_text())
        found["prose with a word of our own"] += [f"{path.name} {word}" for word in words]
    for name, modules in folders.items():
        found["modules too many in a folder"] += [name] * max(0, modules - MODULES.get(name, 20))
    found["classes twice in a room"] = [name for name, times in classes.items() if times > 1]
    return found


if __name__ == "__main__":
    counts = count()
    for kind, most in CEILINGS.items():
        print(f"{kind:<40}{len(counts[kind]):>8} of at most {most}")
        if sys.argv[1:] and kind != "lines of code":
            print(*(f"    {one}" for one in counts[kind]), sep="\n")
    sys.exit(any(len(counts[kind]) > most for kind, most in CEILINGS.items()))
