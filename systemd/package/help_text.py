"""What the programs say of themselves (--help, as CLI11 prints it), for pages, completion and reference."""
import os
import re
import subprocess

OPTION = re.compile(
    r"(?P<names>-\S+?)(?: (?P<type>[A-Z]+))?"
    r"(?::(?P<check>\{[^}]*\}|[A-Z]+ in \[[^\]]*\]|[A-Z]+))?(?:=(?P<default>\S+))?(?P<rest>(?: .*)?)$")


class Help:
    """--help of a program or of one of its commands."""

    def __init__(self, program, *command):
        self.name = os.path.basename(program)
        run = subprocess.run([program, *command, "--help"], capture_output=True, text=True, check=True)
        head, _, rest = run.stdout.partition("Usage: ")
        usage, _, rest = rest.partition("\n")
        self.what = head.strip()
        self.usage = re.sub(r"^\S+", self.name, usage.strip())
        self.sections = {}  # title -> [[term, text]]
        self.footer = ""
        entries = None
        lines = rest.split("\n")
        for i, line in enumerate(lines):
            title = re.fullmatch(r"([A-Z][A-Za-z ]*):", line)
            if title:
                entries = self.sections.setdefault(title[1], [])
            elif line.startswith(" " * 20) and entries:
                entries[-1][1] = (entries[-1][1] + " " + line.strip()).strip()
            elif line.startswith("  ") and entries is not None:
                fits = len(line) > 30 and line[29] == " "  # the text stands beside the term
                entries.append([line[:30].strip(), line[30:].strip()] if fits else [line.strip(), ""])
            elif line.strip():  # neither a section nor in one
                self.footer = "\n".join(lines[i:]).strip()
                break

    def positionals(self):
        """(name, text) of each."""
        return [(term.split()[0], text) for term, text in self.sections.get("Positionals", [])]

    def repeats(self, name):
        """Whether that positional takes several words."""
        return any("..." in term for term, _ in self.sections.get("Positionals", []) if term.split()[0] == name)

    def options(self):
        """(title of the section, Option) of each."""
        for title, entries in self.sections.items():
            for term, text in entries:
                if term.startswith("-"):
                    yield title, Option(term, text)

    def groups(self):
        """{title: {command: [aliases]}}; any section that holds neither options nor positionals."""
        found = {}
        for title, entries in self.sections.items():
            if title == "Positionals" or any(term.startswith("-") for term, _ in entries):
                continue
            names = [re.split(r",\s*", term) for term, _ in entries]
            found[title] = {name: aliases for name, *aliases in names}
        return found

    def commands(self):
        return [name for names in self.groups().values() for name in names]


class Option:
    def __init__(self, term, text):
        found = OPTION.match(term)
        if not found:
            raise SystemExit(f"cannot read option '{term}'")
        self.names = found["names"].split(",")
        self.text = text
        self.default = found["default"]
        check = found["check"] or ""
        self.choices = check[1:-1].split(",") if check.startswith("{") else []
        self.takes_value = bool(found["type"])
        self.value = ""
        if self.choices:
            self.value = "|".join(self.choices)
        elif self.takes_value:
            self.value = {"FLOAT": "NUMBER", "INT": "NUMBER", "UINT": "NUMBER"}.get(found["type"], "TEXT")
        limits = re.search(r"in \[(\S+) - (\S+)\]", check)
        notes = [f"{limits[1]} to {limits[2]}"] if limits else []
        if "REQUIRED" in found["rest"]:
            notes.append("needed")
        if "..." in found["rest"]:
            notes.append("may be given more than once")
        if self.default:
            notes.append(f"default {self.default}")
        for word in ("Needs", "Excludes"):
            other = re.search(word + r": (\S+)", found["rest"])
            if other:
                notes.append({"Needs": "with ", "Excludes": "not with "}[word] + other[1])
        self.notes = "; ".join(notes)
