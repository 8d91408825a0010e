#!/usr/bin/env python3
"""Checks the Markdown pages: links, anchors, pictures, tables, and the length of the README.

  check_docs.py ROOT         the pages of the repository at ROOT
  check_docs.py --planted    does the check find faults that are planted in a folder of its own?

Every relative link must name a file or folder of the repository, every anchor a heading of its page
(GitHub's rule), and no page under docs/ may be out of reach from README.md. docs/reference/ is
generated: links into it are checked where it is there. Each row of a table must have as many cells
as its head.
"""
import pathlib
import re
import sys
import tempfile

README_BYTES = 12000
GENERATED = "docs/reference"
PAGES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "config/tour/README.md", "examples/README.md"]
LINK = re.compile(r"\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$", re.MULTILINE)


def prose(text):
    """The page without code, where brackets are no links and # is no heading."""
    text = re.sub(r"^(```|~~~).*?^\1\s*$", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"(?m)^(?: {4}|\t).*$", "", text)


def anchors(text):
    """The anchors of a page's headings."""
    seen, result = {}, set()
    for heading in HEADING.findall(prose(text)):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        count = seen.get(anchor, 0)
        seen[anchor] = count + 1
        result.add(anchor if count == 0 else f"{anchor}-{count}")
    return result


def pages_of(root):
    return [root / page for page in PAGES if (root / page).is_file()] + sorted(
        (root / "docs").rglob("*.md"))


def ragged_rows(text):
    """Rows of tables with another number of cells than the head of their table."""
    cells, found = 0, []
    for line in prose(text).split("\n"):
        count = len(re.findall(r"(?<!\\)\|", line)) if line.startswith("|") else 0
        if count and cells and count != cells:
            found.append(line)
        cells = count and (cells or count)
    return found


def faults(root):
    """One line for each fault, and the page that has it."""
    found, reached = [], {}
    pages = pages_of(root)
    for page in pages:
        name = page.relative_to(root)
        text = page.read_text()
        reached[page] = set()
        found += [f"{name}: this row has more or fewer cells than its head: {row[:60]}"
                  for row in ragged_rows(text)]
        for link in LINK.findall(re.sub(r"`[^`\n]*`", "", prose(text))):
            if re.match(r"[a-z][a-z0-9+.-]*:", link):
                continue
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            if not target.is_relative_to(root):
                found.append(f"{name}: {link} leaves the repository")
            elif target.is_relative_to(root / GENERATED) and not (root / GENERATED).is_dir():
                continue
            elif not target.exists():
                found.append(f"{name}: {link} is not there")
            else:
                reached[page].add(target)
                if anchor and (target.suffix != ".md" or anchor not in anchors(target.read_text())):
                    found.append(f"{name}: {link} is no heading of that page")
    linked, new = set(), {root / "README.md"}
    while new:
        linked |= new
        new = set().union(*(reached.get(page, set()) for page in new)) - linked
    found += [f"{page.relative_to(root)} is linked from no page" for page in pages
              if page.is_relative_to(root / "docs") and page not in linked]
    length = (root / "README.md").stat().st_size
    if length > README_BYTES:
        found.append(f"README.md has {length} bytes; allowed: {README_BYTES}")
    return found


def planted():
    """The faults that the check must find in pages made for it."""
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name).resolve()
        (root / "docs").mkdir()
        (root / "README.md").write_text(
            "# Top\n[a](docs/a.md#the-place-a) [b](docs/b.md) [c](docs/reference/c.md) [d](#top)\n"
            "[e](docs/a.md#nowhere) [f](../x) [w](https://example.org/x) ![p](p.png)\n"
            "    [code](none)\n```\n[code](none)\n```\n" + "x" * README_BYTES)
        (root / "docs/a.md").write_text(
            "## The *place*: `a`\n[back](../README.md#top)\n\n|a|b|\n|-|-|\n|1|\\|2|\n|1|\n")
        (root / "docs/lost.md").write_text("# Lost\n")
        expected = {"README.md: docs/b.md is not there", "README.md: p.png is not there",
                    "README.md: docs/a.md#nowhere is no heading of that page",
                    "README.md: ../x leaves the repository", "docs/lost.md is linked from no page",
                    "docs/a.md: this row has more or fewer cells than its head: |1|"}
        found = set(faults(root))
        long = {line for line in found if line.startswith("README.md has ")}
        return [] if found - long == expected and len(long) == 1 else sorted(found ^ expected)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = planted() if sys.argv[1] == "--planted" else faults(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(found) or "in order")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
