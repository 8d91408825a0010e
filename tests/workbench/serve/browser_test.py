"""A test in a real browser as a program: its options, its temporary folder, its exit code."""
import argparse
import pathlib
import tempfile

from chromium import find
from server_process import NoPage

SKIPPED = 77


class Skip(Exception):
    """Why a test cannot run here."""


def expect(what, happened):
    if not happened:
        raise AssertionError(what)


def run(test):
    """Runs test(args, folder); exit code 77 where there is no Chromium or no page, or it raises Skip."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=lambda text: pathlib.Path(text).resolve(), required=True)
    parser.add_argument("--source", type=lambda text: pathlib.Path(text).resolve(), required=True)
    parser.add_argument("--pictures", type=pathlib.Path)
    args = parser.parse_args()
    if not find():
        print("chromium is missing: scripts/install-packages browser")
        return SKIPPED
    if args.pictures:
        args.pictures.mkdir(parents=True, exist_ok=True)
    try:
        with tempfile.TemporaryDirectory() as folder:
            test(args, pathlib.Path(folder))
    except (NoPage, Skip) as missing:
        print(missing)
        return SKIPPED
    return 0


def open_live(browser, url):
    """The live page with the thesis's calibrated model beside the stand, once it draws samples."""
    page = browser.page(url)
    page.wait("document.body.dataset.ready === 'yes'")
    page.choose("#model", "shipped:thesis_calibrated.toml")
    page.wait("document.querySelector('#model').value === 'thesis_calibrated.toml'")
    page.run("document.querySelector('a[href=\"#live\"]').click()")
    page.wait("document.querySelector('.stack') && document.querySelector('.stack').dataset.points > 400")
    return page
