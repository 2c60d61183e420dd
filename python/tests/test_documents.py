"""Programs in the documents run and print the shown output."""

import pathlib
import re

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"


def test_the_interfaces_page_shows_the_actual_output(capsys, monkeypatch):
    monkeypatch.chdir(DOCS.parent)
    text = (DOCS / "interfaces.md").read_text()
    shown = re.search(r"```text\n(.*?)```", text, re.DOTALL).group(1)
    row, identification = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names = {}
    exec(compile(row, "interfaces.md", "exec"), names)
    assert capsys.readouterr().out == shown
    exec(compile(identification, "interfaces.md", "exec"), names)
    assert "Emps" in capsys.readouterr().out
