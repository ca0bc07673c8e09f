#!/usr/bin/python3
"""links.py SITE: finds links, pictures and anchors of a static site that lead nowhere, and whatever a reader without a network
could not see."""
import os
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urldefrag, urlsplit


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(attributes[name] for name in ("id", "name") if attributes.get(name))
        for name in ("href", "src"):
            if attributes.get(name) is not None:
                self.links.append((tag, attributes[name]))


def broken(site):
    """Returns a line for each broken link of the pages in this folder."""
    paths = [os.path.join(folder, name) for folder, _, names in os.walk(site) for name in names if name.endswith(".html")]
    pages = {os.path.realpath(path): Page(path) for path in sorted(paths)}
    wrong = []
    for path, page in pages.items():
        for tag, link in page.links:
            address, anchor = urldefrag(link)
            if urlsplit(link).scheme in ("http", "https", "data", "mailto"):
                if tag != "a" and urlsplit(link).scheme != "data":
                    wrong.append(f"{path}: {link}: needs a network")
                continue
            target = os.path.realpath(os.path.join(os.path.dirname(path), unquote(address))) if address else path
            if not os.path.isfile(target):
                wrong.append(f"{path}: {link}: there is no such file")
            elif anchor and target in pages and unquote(anchor) not in pages[target].anchors:
                wrong.append(f"{path}: {link}: the page has no such place")
    return wrong


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit("\n".join(broken(sys.argv[1])) or None)
