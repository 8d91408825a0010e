#!/usr/bin/env python3
"""From a dropped record to a fallen error, in a real browser: what an engineer does on the page.

  story.py --bin DIR --source DIR [--pictures DIR]      exit code 77: there is no Chromium
"""
import json
import shutil
import subprocess
import sys
import time

sys.dont_write_bytecode = True
import browser_test  # noqa: E402
from browser_test import expect  # noqa: E402
from chromium import Browser  # noqa: E402
from server_process import Server  # noqa: E402

HOSTILE = "<img src=x onerror=alert(1)><script>"
# Every text of a model that a page shows.
HOSTILE_MODEL = f"""schema_version = 1
name = "{HOSTILE}"
plant = "velocity_servo"
[parameters]
gain_mps_per_V = 0.05
time_constant_s = 0.01
[effects.hostile]
[formula_effects.hostile]
site = "opening"
formula = "(1 + c) * x_m"
what = "{HOSTILE}"
[formula_effects.hostile.parameters.c]
what = "{HOSTILE}"
min = -1.0
max = 1.0
typical = 0.1
neutral = 0.0
"""
DRAW_A_LAW = """(async () => {
  const {html, render} = await import('/preact.js'), {Law} = await import('/laws.js');
  const place = document.body.appendChild(document.createElement('div'));
  const law = {title: 'drag', note: '', x: 'velocity, mm/s', y: 'force, N', model: {x: [0, 1, 2], y: [0, 1, 8]},
               low: [null, 0.5, 7], high: [null, 1.5, 9]};
  render(html`<${Law} law=${law} />`, place);
  const band = place.querySelector('path.band').getAttribute('d');
  place.remove();
  return band;
})()"""


def figure(page, label):
    return page.run("[...document.querySelectorAll('.figures div')].find((d) => d.querySelector('dt').textContent === "
                    f"{json.dumps(label)}).querySelector('dd').textContent")


def drawn(page, since):
    page.wait(f"Number(document.querySelector('.stack').dataset.drawn || 0) > {since}")
    return page.run("Number(document.querySelector('.stack').dataset.drawn)")


def story(args, folder):
    tour = args.source / "config" / "tour"
    picture = (lambda page, name: page.picture(args.pictures / (name + ".png"))) if args.pictures else lambda *_: None
    with Server(str(args.bin / "spoolwatch"), folder / "session") as server, Browser() as browser:
        page = browser.page(server.url)
        page.wait("document.body.dataset.ready === 'yes'")
        expect("the token is off the address", server.token not in page.run("location.href"))
        expect("the token is in no cookie that the page can read", page.run("document.cookie") == "")

        # A record is dropped, a model chosen.
        page.drop_files("#upload", [tour / "multisine.csv"])
        page.wait("document.querySelector('#record').value === 'multisine.csv'")
        page.choose("#model", "shipped:thesis.toml")
        count = drawn(page, 0)
        page.wait("document.querySelector('.verdict.bad')")
        expect("the verdict is in words", "constant speed" in page.run("document.querySelector('.verdict').innerText"))
        expect("the error before", figure(page, "error, drift-corrected") == "1.92 mm")
        expect("where it fails", "reversing" in page.run("document.querySelector('.regions').innerText"))
        picture(page, "compare")

        # A slider is dragged: the curve follows, the command line says how.
        page.run("(() => { const s = document.getElementById('parameter-damping_N_s_per_m');"
                 " s.value = 900; s.dispatchEvent(new Event('input', {bubbles: true})); })()")
        count = drawn(page, count)
        page.wait("document.querySelector('.commands .now')"
                  " && document.querySelector('.commands .now').textContent.includes('--set parameters.damping')")
        picture(page, "slider")
        page.click_text("Reset")
        page.wait("!document.querySelector('.commands .now')")
        count = page.run("Number(document.querySelector('.stack').dataset.drawn)")

        # A stretch is zoomed, another left out with the mouse and counted again.
        page.run("document.querySelector('.stack').scrollIntoView({block: 'center'})")
        box = page.run("(() => { const r = document.querySelector('.u-over').getBoundingClientRect();"
                       " return [r.left, r.top, r.width, r.height]; })()")
        middle = box[1] + box[3] / 2
        page.drag(box[0] + 0.3 * box[2], middle, box[0] + 0.6 * box[2], middle)
        count = drawn(page, count)
        page.wait("!([...document.querySelectorAll('button')].find((b) => b.textContent === 'Whole record').disabled)")
        page.click_text("Whole record")
        count = drawn(page, count)
        page.click_text("Leave out a stretch")
        page.drag(box[0] + 0.1 * box[2], middle, box[0] + 0.2 * box[2], middle)
        page.wait("document.querySelector('.bands button')")
        page.wait("document.querySelector('.commands').innerText.includes('--ignore')")
        page.click(".bands button")
        page.wait("!document.querySelector('.bands button')")

        # The same by the keyboard: nearer, along, out, and what is shown is left out.
        count = page.run("Number(document.querySelector('.stack').dataset.drawn)")
        for key in ("+", "ArrowRight", "-", "+"):
            page.key(".stack", key)
            count = drawn(page, count)
        page.click_text("Leave out what is shown")
        page.wait("document.querySelector('.bands button')")
        page.click(".bands button")
        page.wait("!document.querySelector('.bands button')")
        page.key(".stack", "0")
        page.wait("([...document.querySelectorAll('button')].find((b) => b.textContent === 'Whole record').disabled)")

        # By finger, as on a tablet: two apart bring it nearer, one moves it; by buttons farther and back.
        def shown():
            return [float(v) for v in page.run("document.querySelector('.stack').dataset.shown").split(":")]

        def turned(by):
            before = shown()
            by()
            page.wait(f"document.querySelector('.stack').dataset.shown !== '{before[0]}:{before[1]}'")
            after = []
            while after != shown():  # until it stands still
                after = shown()
                time.sleep(0.5)
            return before, after

        def finger(share):
            return box[0] + share * box[2], middle

        page.wait("document.querySelector('.stack').dataset.shown.startsWith('0:')")
        before, after = turned(lambda: page.touch([finger(0.4), finger(0.6)], [finger(0.3), finger(0.7)]))
        span = (before[1] - before[0]) / 2
        expect(f"{after} is the middle half of {before}", abs(after[1] - after[0] - span) < 0.05 * span
               and abs(sum(after) - sum(before)) < 0.1 * span)
        before, after = turned(lambda: page.touch([finger(0.5)], [finger(0.3)]))
        expect(f"{after} is a fifth later than {before}", abs(after[0] - before[0] - 0.2 * span) < 0.02 * span
               and abs(after[1] - before[1] - 0.2 * span) < 0.02 * span)
        before, after = turned(lambda: page.click("button[aria-label='earlier']"))
        expect(f"{after} is a quarter earlier than {before}", abs(before[0] - after[0] - span / 4) < 0.02 * span)
        page.click_text("Leave out a stretch")
        page.touch([finger(0.2)], [finger(0.4)])
        page.wait("document.querySelector('.bands button')")
        page.click(".bands button")
        page.wait("!document.querySelector('.bands button')")
        page.click("button[aria-label='zoom out']")
        page.wait("([...document.querySelectorAll('button')].find((b) => b.textContent === 'Whole record').disabled)")

        # What is missing: progress, the trial, the fallen error, acceptance.
        page.click_text("Diagnose")
        page.wait("document.querySelector('.progress') || document.querySelector('.result')")
        page.wait("document.querySelector('.verdict .tag')", 120)
        expect("the diagnosis names both", all(
            name in page.run("document.querySelector('.result .words').textContent")
            for name in ("null_bias", "friction")))
        expect("the error after", figure(page, "error, drift-corrected") == "2.43 µm")
        picture(page, "trial")
        # The laws of both models beside what the record shows.
        page.run("document.querySelector('details.laws summary').click()")
        page.wait("document.querySelector('.law-curve svg path.model')")
        page.wait("document.querySelector('.law-curve svg path.before')")
        laws = page.run("document.querySelector('details.laws').textContent")
        for text in ("Speed over command", "speed, mm/s", "Resisting force over speed", "force, N"):
            expect(f"{text} in {laws}", text in laws)
        expect("samples are drawn", page.run("document.querySelector('.law-curve .dots').getAttribute('d').length") > 3000)
        if args.pictures:
            page.run("document.querySelector('details.laws').scrollIntoView({block: 'end'})")
        picture(page, "laws")
        page.click_text("Accept")
        page.wait("document.querySelector('#model').value === 'thesis-diagnosed.toml'")
        rows = page.run("[...document.querySelectorAll('.ladder .error')].map((e) => e.textContent)")
        expect(f"the ladder falls: {rows}", rows == ["1.96 mm", "2.42 µm"])

        # The first model beside the accepted one: errors, and only what differs.
        page.click("button[aria-label='beside thesis.toml']")
        page.wait("document.querySelector('.side-by-side')")
        sides = page.run("document.querySelector('.side-by-side').innerText")
        for text in ("thesis-diagnosed.toml", "1.92 mm", "2.43 µm", "friction: Coulomb", "null_bias: offset", "supply pressure"):
            expect(f"{text} in {sides}", text in sides)
        for text in ("area", "friction: static"):
            expect(f"{text} does not differ", text not in sides)
        page.wait("[...document.querySelectorAll('.u-label')].some((l) => l.textContent === 'thesis.toml')")
        page.run("document.querySelector('.side-by-side').scrollIntoView({block: 'start'})")
        picture(page, "side-by-side")
        page.click("button[aria-label='beside thesis.toml']")
        page.wait("!document.querySelector('.side-by-side')")

        # A candidate of the model that was diagnosed is tried, although the accepted one has it; the others stay.
        page.click("button[aria-label='try friction']")
        page.wait("document.querySelector('.result h2').textContent === 'Tried: thesis.toml + null_bias + friction'", 120)
        page.wait("document.querySelector('.verdict .tag')")
        page.wait("document.querySelector('.result ~ .result button[aria-label=\"try backlash\"]')")
        # The curves of the model before can be hidden, so that the axes fit those of the trial.
        off = "[...document.querySelectorAll('.u-series.u-off .u-label')].filter((l) => l.textContent === 'before').length"
        page.wait(off + " === 0")
        page.click_text("Hide before")
        page.wait(off + " === 2")
        picture(page, "tried")
        page.click_text("Hide before")
        page.wait(off + " === 0")
        page.click_text("Undo")
        page.wait("!document.querySelector('.verdict .tag') && document.querySelector('#model').value"
                  " === 'thesis-diagnosed.toml'")

        # Checked on another record, and taken away.
        page.drop_files("#upload", [tour / "steps.csv"])
        page.wait("document.querySelector('#record').value === 'steps.csv'")
        page.wait("document.querySelector('.verdict.good')")
        expect("candidates of another record are not tried",
               page.run("document.querySelector('button[aria-label=\"try backlash\"]').disabled"))
        page.click_text("Write a report")
        page.wait("[...document.querySelectorAll('.exports a')].some((a) => a.textContent.endsWith('.html'))")
        picture(page, "accepted")

        # Mistakes are told in a line, names of files are text.
        hostile = folder / (HOSTILE + ".csv")
        hostile.write_text((tour / "steps.csv").read_text())
        page.drop_files("#upload", [hostile])
        page.wait("document.querySelector('#record').value.startsWith('<img')")
        hostile = folder / (HOSTILE + ".toml")
        hostile.write_text(HOSTILE_MODEL)
        page.drop_files("#upload", [hostile])
        page.wait("document.querySelector('#model').value.startsWith('<img')")
        page.wait("document.querySelector('.sliders').innerText.includes('hostile')")
        page.run("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
        page.click_text("Write a report")
        page.wait("document.querySelector('.message')")
        report = max((folder / "session").glob("*.html"), key=lambda file: file.stat().st_mtime).read_text()
        expect("the report has no element of a name", "<img src=x" not in report)
        (folder / "bad.csv").write_text("t_s,u_V,y_m\n0,1,2\n0.01,x,3\n")
        page.drop_files("#upload", [folder / "bad.csv"])
        page.wait("document.querySelector('[role=alert]')")
        expect("no element came from a name", page.run("document.querySelectorAll('#app img, #app script').length") == 0)
        expect("no mapping helps a damaged row", page.run("document.querySelector('#map')") is None)

        # A record whose columns are not understood is read as the engineer says: proposed, wrong, right.
        rows = (tour / "steps.csv").read_text().splitlines()[1:]
        (folder / "bench.txt").write_text("\n".join(["time;voltage;pos"] + [row.replace(",", ";") for row in rows]))
        page.drop_files("#upload", [folder / "bench.txt"])
        page.wait("document.querySelector('#map')")
        proposed = page.run("document.querySelector('#map').value")
        expect(f"{proposed} is the mapping", proposed == "t=time[s],u=voltage[V],y=pos[m]")
        picture(page, "read-as")
        page.type("#map", "t=time[s],u=voltage[V],y=position[m]")
        page.click_text("Read it so")
        page.wait("document.querySelector('[role=alert]')?.innerText.includes('there is no column position')")
        page.type("#map", "t=time[s],u=voltage[V],y=pos[m]")
        page.click_text("Read it so")
        page.wait("document.querySelector('#record').value === 'bench-imported.csv'")
        expect("the question is gone", page.run("document.querySelector('#map')") is None)
        def numbers(file):
            lines = [line for line in file.read_text().splitlines() if line[:1].isdigit()]
            return [[float(field) for field in line.split(",")[:3]] for line in lines]

        expect("the record is the same", numbers(folder / "session" / "bench-imported.csv") == numbers(tour / "steps.csv"))
        page.wait("document.querySelector('.commands').innerText.includes("
                  "\"spoolwatch import bench.txt --map 't=time[s],u=voltage[V],y=pos[m]' -o bench-imported.csv\")")

        # A model from the numbers of data sheets; what is missing is named.
        page.run("document.querySelector('details.make').open = false")
        page.click("details.make summary")
        page.choose("#kind", "velocity-servo")
        page.type("#new-full-speed-mmps", "500")
        page.type("#new-lag-ms", "12,5")
        page.click_text("Make velocity-servo.toml")
        page.wait("document.querySelector('#model').value === 'velocity-servo.toml'")
        made = (folder / "session" / "velocity-servo.toml").read_text()
        for text in ("gain_mps_per_V = 0.05", "time_constant_s = 0.0125",
                     "spoolwatch new velocity-servo -o velocity-servo.toml"):
            expect(f"{text} in {made}", text in made)

        expect("a band with a law", page.run(DRAW_A_LAW).count("L") == 3)

        # Cancel ends a diagnosis with the best so far; the page may be gone meanwhile.
        page.choose("#record", "multisine.csv")
        page.choose("#model", "thesis.toml")
        page.wait("document.querySelector('#model').value === 'thesis.toml'")
        page.wait("document.querySelector('.verdict.bad')")
        page.click_text("Diagnose")
        page.click_text("Cancel")
        page.wait("!document.querySelector('.progress')", 120)

        for width, height in ((1280, 800), (1024, 768), (800, 1280)):
            page.size(width, height, dark=True)
            expect(f"nothing is wider than {width}", page.run("document.documentElement.scrollWidth") <= width)
            picture(page, f"dark-{width}")
        wrong, asked = page.said()
        expect(f"refused uploads alone are complained of: {wrong}", all("422" in one for one in wrong))
        expect(f"nothing is asked of another host: {asked}",
               all(one.startswith(f"http://127.0.0.1:{server.port}/") for one in asked))
        script = (folder / "session" / "commands.sh").read_text()
        expect("no file of the session knows the token", not any(
            server.token in file.read_text(errors="replace") for file in (folder / "session").iterdir()))
        expect("the server ends", server.end() == 0)

    # The script of the session does the same without a page.
    again = folder / "again"
    again.mkdir()
    for name in ("multisine.csv", "thesis.toml"):
        shutil.copy(folder / "session" / name, again)
    command = next(line for line in script.splitlines() if line.startswith("spoolwatch diagnose"))
    subprocess.run(command, shell=True, cwd=again, check=True, capture_output=True,
                   env={"PATH": f"{args.bin}:/usr/bin:/bin"})
    def values(where):
        text = (where / "thesis-diagnosed.toml").read_text()
        return [line for line in text.splitlines() if not line.startswith("#")]

    same = [values(where) for where in (again, folder / "session")]
    expect("the command line of the page writes the same model", same[0] == same[1])


if __name__ == "__main__":
    sys.exit(browser_test.run(story))
