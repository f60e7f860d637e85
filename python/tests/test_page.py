"""The examples of the book's page run, one after the other, from the root of the repository."""

import matplotlib
import pytest

from conftest import ROOT


def test_the_examples_of_the_page_run(monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib.use("Agg")
    monkeypatch.chdir(ROOT)
    page = (ROOT / "docs" / "src" / "python.md").read_text(encoding="utf-8")
    blocks = [block.split("```")[0] for block in page.split("```python\n")[1:]]
    assert len(blocks) > 5
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, "python.md", "exec"), names)
    lower = names["lower"]
    assert lower["contact.friction"] == 0.04  # type: ignore[index]
