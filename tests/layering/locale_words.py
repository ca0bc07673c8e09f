"""locale_words.py FOLDER...: fails if a source file uses a function whose result depends on the locale. Qt sets the
locale of the process, so that in the program with a screen strtod() would read "2.75" as 2 where a comma is the decimal
mark. Use std::from_chars, text::read_number, fmt or Qt's own functions. Without arguments, tries itself."""
import os
import re
import sys

WORDS = re.compile(r"\b(strto(d|f|ld)|ato[fF]|sto(d|f|ld)|setlocale|localeconv|strcasecmp|strncasecmp|strcoll|"
                   r"std::locale|imbue)\b\s*\(|\b(std::)?to(lower|upper)\s*\(|"
                   r"\bsn?printf\s*\([^;]*%[-+ 0-9.*]*[aefgAEFG]|\bsscanf\s*\([^;]*%l?[aefg]")


def found(text):
    text = re.sub(r"//[^\n]*", "", text)
    return [(text.count("\n", 0, match.start()) + 1, match.group()) for match in WORDS.finditer(text)]


def main():
    for line in ("strtod(a, 0)", "std::stod(x)", "std::tolower(c)", 'std::snprintf(b, 9, "%.3f", x)'):
        assert found(line), line
    for line in ("text::read_number(a)", "a.toDouble()", 'std::snprintf(b, 9, "%02x", x)', "// strtod(a)"):
        assert not found(line), line
    bad = []
    for folder in sys.argv[1:]:
        for path, _, names in os.walk(folder):
            for name in names:
                if name.endswith((".cpp", ".hpp")):
                    with open(os.path.join(path, name), encoding="utf-8") as file:
                        bad += [f"{path}/{name}:{line}: {word}" for line, word in found(file.read())]
    print("\n".join(bad))
    sys.exit(1 if bad else 0)


main()
