"""What a launch hands on: the command's seed to every sensor, the Earth orientation file to the digest of the run, as
many starts as the scenario allows. Links in its directory of logs are replaced, not followed.

    launched.py DMISE
"""

import json
import os
import signal

from harness import Run, check, check_same, main, wait_until, write_scenario

FINALS = ("18 121 58139.00 I  0.061568 0.000019  0.274259 0.000019  I 0.{dut1} 0.0000114\n"
          "18 122 58140.00 I  0.062568 0.000019  0.275259 0.000019  I 0.{dut1} 0.0000114\n")


def frames_of(out):
    return [path.read_bytes() for path in sorted(out.glob("*/*.fits"))]


def made(binary, command, scenario, out, *more):
    with Run(binary, command, scenario, "--out", out, *more) as run:
        code, _ = run.finish()
        return code, run.stdout + run.stderr


def test(binary, directory):
    scenario = write_scenario(directory, duration_s=20)
    one, other, launched = directory / "one", directory / "other", directory / "launched"
    for command, out, seed in (("run", one, 1), ("run", other, 7), ("launch", launched, 7)):
        check(made(binary, command, scenario, out, "--seed", str(seed))[0] == 0, f"{command} --seed {seed}")
    check_same(launched, other, "a launch draws by the command's seed")
    check(frames_of(other) != frames_of(one), "and another seed is another noise")

    text = scenario.read_text().replace("seed: 1", "seed: 1, earth_orientation: finals.txt")
    (directory / "measured.yaml").write_text(text)
    out = directory / "measured"
    for dut1, wanted in (("2045678", 0), ("2045678", 0), ("1945678", 2)):
        (directory / "finals.txt").write_text(FINALS.format(dut1=dut1))
        code, said = made(binary, "run", directory / "measured.yaml", out)
        check(code == wanted, f"UT1 - UTC = 0.{dut1} s: code {code}")
    check("another run" in said, "with another Earth orientation file it is another run")

    out, target = directory / "links", directory / "target"
    (out / "logs").mkdir(parents=True)
    target.write_text("of somebody else")
    logs = [out / "logs" / name for name in ("time-master.log", "broker.log", "alpha.log", "orbit-node.log", "master.json",
                                             "master.json.partial", "master.address.partial")]
    for log in (*logs, out / "run.json.partial", out / "index.html.partial"):
        log.symlink_to(target)
    check(made(binary, "launch", scenario, out)[0] == 0, "a launch where links were planted")
    check(target.read_text() == "of somebody else", "leaves the file that they name")
    check(not any(log.is_symlink() for log in logs) and (out / "logs/alpha.log").exists(), "and replaces them")

    again = write_scenario(directory, duration_s=60, on_silent_node="restart", silent_after_s=1.0,
                           network=", restarts: 1, real_time: 12", name="again.yaml")
    out = directory / "again"
    with Run(binary, "launch", again, "--out", out) as run:
        wait_until(lambda: list(out.glob("*/frames.jsonl")), f"a first frame in {out}")
        os.kill(run.node("alpha"), signal.SIGKILL)
        code, _ = run.finish()
        check(code == 0, f"a node that may be started again once is: code {code}")
    check(json.loads((out / "logs/master.json").read_text())["restarts"].get("alpha") == 1, "and was, once")


if __name__ == "__main__":
    main(test)
