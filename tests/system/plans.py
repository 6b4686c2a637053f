"""Plans of effects, as a user sees them: `explain` states errors within the budget, one process and many make the same
bytes under every accuracy, a recorded plan is replayed to the same pixels, and one that does not fit is refused by name.

    plans.py DMISE
"""

import json
import statistics
import subprocess

from harness import check, main, write_scenario

ACCURACIES = ["draft", "standard", "{position_px: 0.3, background_sigma: 0.5}", "{seconds_per_frame: 0.02}"]


def test(binary, directory):
    plain = write_scenario(directory, duration_s=15)
    text = plain.read_text()

    def scenario(name, accuracy, extra=""):
        path = directory / f"{name}.yaml"
        path.write_text(f"accuracy: {accuracy}\n{extra}{text}")
        return path

    def dmise(*arguments, expect=0):
        done = subprocess.run([binary, *arguments], capture_output=True, text=True)
        check(done.returncode == expect, f"{arguments[0]} exits with {expect}: {done.stderr[-300:]}")
        return done

    def files(run):
        return {path.relative_to(run).as_posix(): path.read_bytes() for path in sorted(run.rglob("*"))
                if path.suffix in (".fits", ".jsonl") and path.name != "cost.jsonl" and "logs" not in path.parts}

    def pixels(run):
        return {name: data[-512 * 384 * 2:] for name, data in files(run).items() if name.endswith(".fits")}

    for index, accuracy in enumerate(ACCURACIES):
        path = scenario(f"a{index}", accuracy)
        plans = json.loads(dmise("explain", path, "--json").stdout)
        check([sensor["sensor"] for sensor in plans["sensors"]] == ["alpha", "beta"], "explain lists every sensor")
        for sensor in plans["sensors"]:
            check(sensor["spans"], f"{sensor['sensor']} is planned for {accuracy}")
            for span in sensor["spans"]:
                plan = span["plan"]
                within = all(plan["error"][kind] <= most for kind, most in plan["budget"].items())
                check(within, f"its errors are within the budget: {plan['error']} {plan['budget']}")
                effects = plan["effects"].values()
                check(all(effect["level"] for effect in effects), "each has a level")
                check(all(effect["why"] for effect in effects if "error_of_next_lower" in effect),
                      "each that was decided says why")
        one, many = directory / f"one{index}", directory / f"many{index}"
        dmise("run", path, "--out", one, "--threads", "2")
        dmise("launch", path, "--out", many)
        check(len(files(one)) > 6 and files(one) == files(many), f"one process and many: the same bytes for {accuracy}")

    short = dmise("explain", scenario("text", "standard")).stdout
    check("effect" in short and "--all" in short and len(short.splitlines()) <= 50,
          f"explain has one table of {len(short.splitlines())} lines for all sensors")
    check("why" in dmise("explain", scenario("text", "standard"), "--all").stdout, "and with --all the reasons")
    told = json.loads(dmise("check", scenario("text", "standard"), "--json").stdout)["sensors"]
    explained = json.loads(dmise("explain", scenario("text", "standard"), "--json").stdout)["sensors"]
    lines = [json.loads(line) for line in (directory / "one1/frames.jsonl").read_text().splitlines()]
    for of, also in zip(told, explained):
        limit = of["limiting_magnitude"]
        measured = statistics.median(f["limiting_magnitude"] for f in lines if f["sensor"] == of["name"])
        check(also["limiting_magnitude"] == limit and f"limiting magnitude V = {limit:.2f};" in short,
              f"check and explain tell one limiting magnitude of {of['name']}, {limit:.2f}")
        check(abs(measured - limit) < 0.1, f"and frames measure it: {measured:.2f}")
    summary, *rest = (directory / "one1/run.json").read_text().splitlines()
    check(json.loads(summary.removesuffix(",") + "}")["status"] == "complete" and len(summary) < 2000,
          f"the first line of run.json is its summary, {len(summary)} characters")
    check(sum(line.startswith('{"sensor":') for line in rest) == len(lines), "and each frame has a line of its own")

    first = directory / "one0"
    frames = json.loads((first / "run.json").read_text())["frames"]
    check(all(frame["plan"]["effects"] and frame["effects_s"] for frame in frames),
          "run.json has predicted and measured seconds of every frame")

    replayed = directory / "replayed"
    dmise("run", scenario("other", "reference"), "--out", replayed, "--plan", first / "run.json")
    check(pixels(replayed) == pixels(first), "a replayed plan makes the same pixels whatever the accuracy")

    def bounds(run):
        plans = [frame["plan"]["error"] for frame in json.loads((run / "run.json").read_text())["frames"]]
        cards = {name: [data[at:at + 80] for at in range(0, 28800, 80) if data[at:at + 8].rstrip() in (
            b"ERRPHOT", b"ERRPOS", b"ERRBACK", b"ERRNOISE")] for name, data in files(run).items() if name.endswith(".fits")}
        return plans, cards

    check(bounds(replayed) == bounds(first) and any(any(plan.values()) for plan in bounds(first)[0]),
          "and states the same bounds of errors")

    many = directory / "replayed-many"
    dmise("launch", directory / "other.yaml", "--out", many, "--plan", first / "run.json", "--hosts", "1")
    check(files(many) == files(replayed), "and a process per node replays it to the same bytes")

    longer = scenario("longer", "draft")
    longer.write_text(longer.read_text().replace("duration_s: 15", "duration_s: 30"))
    refusal = dmise("run", longer, "--out", directory / "refused", "--plan", first / "run.json", expect=2).stderr
    check("alpha, frame 4: there is none" in refusal and refusal.count("\n") == 1, f"too few frames: {refusal}")
    bent = scenario("bent", "draft")
    (directory / "small.yaml").write_text((directory / "small.yaml").read_text().replace(
        "aperture_m: 0.02", "aperture_m: 0.02, vignetting: {natural: true}"))
    refusal = dmise("run", bent, "--out", directory / "refused", "--plan", first / "run.json", expect=2).stderr
    check("vignetting" in refusal and refusal.count("\n") == 1, f"an effect of today: {refusal}")
    (directory / "no.json").write_text("{}")
    dmise("run", bent, "--out", directory / "refused", "--plan", directory / "no.json", expect=2)
    check(not (directory / "refused").exists(), "what is refused leaves no directory")


main(test)
