"""Opens a page in a browser engine at some widths, and prints what is seen there as JSON.

    python open_in_browser.py PAGE FOLDER WIDTH...

The folder gets a picture at each width and the printed page.  A process of its own: Qt wants the
main thread, and options of the engine stand in the environment.
"""

import json
import os
import sys
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("QTWEBENGINE_DISABLE_SANDBOX", "1")

from PySide6.QtCore import QEventLoop, QSize, QTimer, QUrl
from PySide6.QtWebEngineCore import (
    QWebEnginePage,
    QWebEngineProfile,
    QWebEngineUrlRequestInterceptor,
)
from PySide6.QtWebEngineWidgets import QWebEngineView
from PySide6.QtWidgets import QApplication

SEEN = """
(() => {
  const box = e => { const r = e.getBoundingClientRect(); return [r.width, r.height, r.right]; };
  const wide = document.documentElement.clientWidth;
  const inside = e => e.closest(".scroll");
  return JSON.stringify({
    width: wide,
    scroll: document.documentElement.scrollWidth,
    height: document.documentElement.scrollHeight,
    images: [...document.images].map(i => [i.naturalWidth, ...box(i)]),
    drawings: [...document.querySelectorAll("svg")].map(box),
    beyond: [...document.querySelectorAll("body *")].filter(
      e => !inside(e) && box(e)[2] > wide + 0.5).map(e => e.outerHTML.slice(0, 120)),
    small: Math.min(...[...document.querySelectorAll("p, td, th, li, figcaption")].map(
      e => parseFloat(getComputedStyle(e).fontSize))),
    places: [...document.querySelectorAll("svg polyline.link")].map(e => e.getAttribute("points")),
    controls: !(document.querySelector(".controls") || {hidden: true}).hidden,
  });
})()
"""


class Page(QWebEnginePage):
    def __init__(self, profile):
        super().__init__(profile)
        self.said = []

    def javaScriptConsoleMessage(self, level, message, line, source):
        self.said.append(f"{level.name}: {message}")


class Requests(QWebEngineUrlRequestInterceptor):
    def __init__(self):
        super().__init__()
        self.urls = []

    def interceptRequest(self, info):
        url = info.requestUrl()
        self.urls.append(url.toString()[:200])
        if url.scheme() not in ("file", "data"):
            info.block(True)


def waited(start, limit=60_000):
    """Return what a call hands to its callback, or the arguments of a signal."""
    loop, got = QEventLoop(), []

    def done(*values):
        got.extend(values)
        loop.quit()

    QTimer.singleShot(limit, loop.quit)
    start(done)
    if not got:
        loop.exec()
    return got[0] if got else None


def rest(milliseconds):
    waited(lambda done: QTimer.singleShot(milliseconds, lambda: done(True)))


def main(path, folder, *widths):
    app = QApplication(sys.argv[:1])  # noqa: F841 - lives as long as the views do
    profile, requests = QWebEngineProfile(), Requests()
    profile.setUrlRequestInterceptor(requests)
    page, view = Page(profile), QWebEngineView()
    view.setPage(page)
    view.resize(int(widths[0]), 900)
    view.show()

    def load(done):
        page.loadFinished.connect(done)
        page.load(QUrl.fromLocalFile(str(Path(path).resolve())))

    found = {"loaded": waited(load), "widths": {}}

    def look():
        return json.loads(waited(lambda done: page.runJavaScript(SEEN, done)))

    for width in widths:
        view.resize(int(width), 900)
        rest(400)
        first = look()
        rest(600)
        first["moves"] = look()["places"] != first["places"]
        found["widths"][width] = first
        view.resize(QSize(int(width), min(int(first["height"]) + 20, 12_000)))
        rest(2500)
        view.grab().save(str(Path(folder) / f"{width}.png"))

    def printed(done):
        page.pdfPrintingFinished.connect(lambda file, well: done(well))
        page.printToPdf(str(Path(folder) / "page.pdf"))

    found |= {"printed": waited(printed), "said": page.said, "requests": requests.urls}
    print(json.dumps(found))
    sys.stdout.flush()


if __name__ == "__main__":
    main(*sys.argv[1:])
    os._exit(0)  # the engine's own leave-taking may hang without a display
