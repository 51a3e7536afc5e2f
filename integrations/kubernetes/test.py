"""Reads draw.yaml as Kubernetes would and runs its container's command for every part, without a cluster."""

import json
import os
import re
import subprocess
from pathlib import Path

import yaml
from kubernetes import client

from outcome import outcome
from plain import DRYPOINT, HOSTILE, PORTRAITS, RECIPE, prepare
from processes import MARK
from tally import Tally

HERE = Path(__file__).resolve().parent
FOLDER = Path(os.environ[MARK])
PARTS = 4
tally = Tally()


def check_schema(job: dict) -> None:
    """Through the client's model of a Job and back: an unknown key is lost on the way, a wrong type raises."""
    api = client.ApiClient()
    model = api.deserialize(json.dumps(job), "V1Job", "application/json")
    tally.check(api.sanitize_for_serialization(model) == job, "every key and type is known to Kubernetes")
    spec = job["spec"]
    tally.check(spec["completionMode"] == "Indexed", "the Job is indexed")
    # The API refuses both of these otherwise.
    tally.check(spec["template"]["spec"]["restartPolicy"] == "Never", "retries per index need restartPolicy Never")
    named = {
        rule["onExitCodes"]["containerName"] for rule in spec["podFailurePolicy"]["rules"] if "onExitCodes" in rule
    }
    tally.check(named == {container_of(job)["name"]}, "the failure policy names the container", named)


def container_of(job: dict) -> dict:
    (container,) = job["spec"]["template"]["spec"]["containers"]
    return container


def environment_of(container: dict) -> dict[str, str]:
    """The container's variables, limits in their divisor's units, rounded up."""
    units = {"": 1, "Ki": 2**10, "Mi": 2**20, "Gi": 2**30}

    def number(text: str) -> int:
        found = re.fullmatch(r"(\d+)(\D*)", text)
        return int(found[1]) * units[found[2]]

    values = {}
    for variable in container["env"]:
        if "value" in variable:
            values[variable["name"]] = variable["value"]
            continue
        field = variable["valueFrom"]["resourceFieldRef"]
        amount = number(container["resources"]["limits"][field["resource"].removeprefix("limits.")])
        values[variable["name"]] = str(-(-amount // number(field.get("divisor", "1"))))
    return values


def run_parts(container: dict, data: Path) -> list[int]:
    """Runs the container's command for each index; its folder is the mounted one by another name."""
    (mount,) = container["volumeMounts"]
    words = [word.replace(mount["mountPath"], str(data)) for word in container["command"] + container["args"]]
    programs = FOLDER / "programs"
    programs.mkdir(exist_ok=True)
    if not (programs / "drypoint").exists():
        (programs / "drypoint").symlink_to(DRYPOINT)
    values = {**environment_of(container), "PARTS": str(PARTS), "OPTIONS": " ".join(RECIPE)}
    path = f"{programs}:{os.environ['PATH']}"
    environments = [{**values, "PATH": path, "JOB_COMPLETION_INDEX": str(index)} for index in range(PARTS)]
    return [
        subprocess.run(words, env=environment, stderr=subprocess.DEVNULL).returncode for environment in environments
    ]


def main() -> None:
    job = yaml.safe_load((HERE / "draw.yaml").read_text())
    check_schema(job)
    container = container_of(job)
    values = environment_of(container)
    tally.check(values["PARTS"] == str(job["spec"]["completions"]), "the command knows how many parts there are")
    limits = container["resources"]["limits"]
    tally.check(values["CPUS"] == limits["cpu"] and values["MEMORY"] == "4096", "the command knows its limits", values)

    plain = prepare()
    data = FOLDER / "data"
    data.mkdir()
    (data / "in").symlink_to(plain.folder / "in")
    manifest = data / "portraits.tsv"
    manifest.write_text(plain.manifest.read_text(encoding="utf-8"), encoding="utf-8")
    collect = [
        "bash",
        HERE.parent / "slurm/collect.sbatch",
        manifest,
        data / "results",
        str(PARTS),
        data / "results.jsonl",
    ]
    for attempt, drawn in (("the Job", "done"), ("the Job applied again", "skipped")):
        statuses = run_parts(container, data)
        tally.check(statuses == [0] * PARTS, f"{attempt}: every part ends well", statuses)
        collected = subprocess.run(collect, capture_output=True, encoding="utf-8")
        found = outcome(manifest, data / "results.jsonl", data / "out", plain.digests())
        right = found.is_right(PORTRAITS, HOSTILE) and getattr(found, drawn) == PORTRAITS
        tally.check(right, f"{attempt}: all portraits right, all others reported", found)
        tally.check(collected.returncode == 3 and " 0 lost" in collected.stdout, "collected", collected.stdout.strip())
    (data / "results" / f"2-of-{PARTS}.jsonl").unlink()
    collected = subprocess.run(collect, capture_output=True, encoding="utf-8")
    told = "Parts 2 of 4" in collected.stderr
    tally.check(collected.returncode == 1 and told, "a part that is missing is named", collected.stderr.strip())
    tally.close()


if __name__ == "__main__":
    main()
