#!/usr/bin/env python3
"""The page without a mouse and without good eyes: every control has a name and is reached by the Tab key, the
focus is seen, and text stands out from what is behind it, in both themes (WCAG 2.1: 4.5, large text 3).

  access.py --bin DIR --source DIR [--pictures DIR]      exit code 77: there is no Chromium
"""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
import browser_test  # noqa: E402
from browser_test import expect  # noqa: E402
from chromium import Browser  # noqa: E402
from server_process import Server  # noqa: E402

CONTROLS = {"button", "link", "textbox", "combobox", "slider", "checkbox", "spinbutton", "searchbox", "switch",
            "DisclosureTriangle", "progressbar"}
# Those that a person can use now.
REACHABLE = """[...document.querySelectorAll('a[href], button, input, select, summary, [tabindex="0"]')]
  .filter((one) => !one.disabled && one.tabIndex >= 0 && one.type !== 'file' && one.checkVisibility({visibilityProperty: true}))"""
NAME = "(one) => one.tagName + ' ' + (one.id || one.getAttribute('aria-label') || one.textContent).trim().slice(0, 40)"
# Text whose contrast with the nearest opaque background is too low; disabled controls are exempt.
LOW_CONTRAST = """(() => {
  const parse = (text) => { const v = text.match(/[\\d.]+/g).map(Number); return v.length > 3 ? v : [...v, 1]; };
  const over = (top, below) => [0, 1, 2].map((i) => top[i] * top[3] + below[i] * (1 - top[3])).concat(1);
  const light = (c) => [0, 1, 2].map((i) => c[i] / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = (one) => {
    const layers = [];
    for (; one; one = one.parentElement) {
      const c = parse(getComputedStyle(one).backgroundColor);
      if (c[3] > 0) layers.push(c);
      if (c[3] === 1) break;
    }
    return layers.reverse().reduce((below, top) => over(top, below), [255, 255, 255, 1]);
  };
  const low = new Set();
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const one = walk.currentNode.parentElement;
    if (!walk.currentNode.textContent.trim() || !one.checkVisibility({visibilityProperty: true})) continue;
    if (one.closest(':disabled, script, style, option, svg')) continue;
    const style = getComputedStyle(one), size = parseFloat(style.fontSize), bold = style.fontWeight >= 700;
    const back = behind(one), front = over(parse(style.color), back);
    const [a, b] = [light(front), light(back)].sort((x, y) => y - x), ratio = (a + 0.05) / (b + 0.05);
    if (ratio < (size >= 24 || bold && size >= 18.66 ? 3 : 4.5)) {
      low.add(walk.currentNode.textContent.trim().slice(0, 30) + ' ' + ratio.toFixed(2) + ' ' + style.color);
    }
  }
  return [...low];
})()"""


def check(page, where):
    nodes = page.call("Accessibility.getFullAXTree")["nodes"]
    nameless = [node["role"]["value"] for node in nodes
                if not node.get("ignored") and node["role"]["value"] in CONTROLS
                and not node.get("name", {}).get("value", "").strip()]
    expect(f"{where}: every control has a name: {nameless}", not nameless)

    for dark in (False, True):
        page.size(1280, 800, dark)
        low = page.run(LOW_CONTRAST)
        expect(f"{where}, {'dark' if dark else 'light'}: text stands out: {low}", not low)

    # Every control is reached by Tab, one after the other, and its focus is seen.
    page.run("document.activeElement.blur(); window.getSelection().removeAllRanges(); window.scrollTo(0, 0);"
             f"{REACHABLE}.forEach((one) => one.dataset.reach = 'no')")
    wanted = page.run(f"{REACHABLE}.length")
    unseen = set()
    for _ in range(wanted + 5):
        for kind in ("keyDown", "keyUp"):
            page.call("Input.dispatchKeyEvent", type=kind, key="Tab", code="Tab", windowsVirtualKeyCode=9)
        seen = page.run("(() => { const one = document.activeElement; if (one === document.body) return null;"
                        " one.dataset.reach = 'yes'; const s = getComputedStyle(one);"
                        f" return s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) > 0 ? null : ({NAME})(one); }})()")
        if seen:
            unseen.add(seen)
    missed = page.run(f"[...document.querySelectorAll('[data-reach=no]')].filter((one) => one.isConnected).map({NAME})")
    expect(f"{where}: all {wanted} are reached: {missed}", wanted > 5 and not missed)
    expect(f"{where}: the focus is seen: {unseen}", not unseen)


def watch(args, folder):
    url = f"udpm://239.255.76.67:{20000 + os.getpid() % 10000}?ttl=0"
    daemon = subprocess.Popen(
        [args.bin / "spoolwatchd", "--config", args.source / "config/demo.toml", "--lcm-url", url, "--duration", "120",
         "--set", f"control.socket={folder}/control.sock", "--set", "loop.overrun_action=count", "--set",
         "sim.fault.0.at_s=4"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        with Server(str(args.bin / "spoolwatch"), folder / "session", "--lcm-url", url, "--control",
                    f"{folder}/control.sock", "--allow-orders") as server, Browser() as browser:
            page = browser.page(server.url)
            page.call("Accessibility.enable")
            page.wait("document.body.dataset.ready === 'yes'")
            check(page, "empty workbench")
            page.drop_files("#upload", [args.source / "config/tour/multisine.csv"])
            page.wait("document.querySelector('#record').value === 'multisine.csv'")
            page.choose("#model", "shipped:thesis.toml")
            page.wait("document.querySelector('.verdict.bad')")
            check(page, "workbench")
            page.click_text("Diagnose")
            page.wait("document.querySelector('.verdict .tag')", 120)
            page.run("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
            page.choose("#kind", "velocity-servo")
            page.wait("document.querySelector('#new-full-speed-mmps')")
            check(page, "trial")

            page.run("document.querySelector('a[href=\"#live\"]').click()")
            page.wait("document.querySelector('.alarms li.MAJOR')", 60)
            page.choose("#trigger-mode", "normal")
            page.wait("document.querySelector('#trigger-level')")
            page.run("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
            check(page, "live stand")
    finally:
        daemon.kill()
        daemon.wait()


if __name__ == "__main__":
    sys.exit(browser_test.run(watch))
