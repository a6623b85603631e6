"""The benchmarks' command: python -m benchmarks --help."""

from __future__ import annotations

import argparse
import json
import os
import platform
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import contestants
from .scenes import NAMES, prepared

QUICK = ("box", "mis", "pots", "sun", "room")


def machine() -> dict[str, Any]:
    """Where and when these numbers were measured."""
    model = platform.processor()
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [line for line in info.read_text().splitlines() if line.startswith("model name")]
        model = names[0].split(":", 1)[1].strip() if names else model
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    date = time.strftime("%Y-%m-%d %H:%M", time.gmtime())
    return {"date": date, "processor": model, "cores": os.cpu_count(), "load_before": load}


def run_compare(arguments: argparse.Namespace) -> tuple[str, Any]:
    """The peers."""
    from .compare import compare, table

    results = []
    options = {"as_users": True} if arguments.settings == "users" else {}
    options |= {"uncoated": True} if arguments.uncoated else {}
    for scene in arguments.scenes:
        results += compare(
            scene,
            arguments.renderers,
            arguments.size,
            arguments.spp,
            arguments.repeats,
            arguments.threads,
            options,
        )
    return table(results), [result.row() for result in results]


def run_limit(arguments: argparse.Namespace) -> tuple[str, Any]:
    """The bare tracing of the same rays."""
    from .limit import measure
    from .world import World

    rows = []
    lines = [
        "| scene | triangles | rays a sample | bare Mrays/s | render Mrays/s | fraction of limit |",
        "|---|---|---|---|---|---|",
    ]
    for scene in arguments.scenes:
        world = World.read(prepared(scene))
        limit = measure(world, arguments.size, arguments.spp, arguments.repeats, arguments.threads)
        rows.append({"triangles": world.triangles, **limit.row()})
        lines.append(
            f"| {scene} | {world.triangles:,} | {limit.rays_per_sample:.1f} | {limit.bare_mrays:.2f} "
            f"| {limit.render_mrays:.2f} | {limit.fraction:.2f} ± {limit.spread:.2f} |"
        )
    return "\n".join(lines), rows


def run_startup(arguments: argparse.Namespace) -> tuple[str, Any]:
    """Waiting before anything is rendered."""
    from .startup import measure

    found = measure(arguments.repeats)
    lines = ["| command | seconds, median | least | of the processor |", "|---|---|---|---|"]
    for name, value in found.items():
        lines.append(f"| {name} | {value['median']:.2f} | {value['least']:.2f} | {value['processor']:.2f} |")
    return "\n".join(lines), found


def run_load(arguments: argparse.Namespace) -> tuple[str, Any]:
    """Loading, beside Embree's build alone."""
    from .loading import measure

    found = [measure(scene, arguments.repeats) for scene in arguments.scenes]
    ways = ("arrays", "file", "file, cached")
    lines = [
        f"| scene | triangles | Embree alone, s | {' | '.join(ways)} | times as long: {' | '.join(ways)} |",
        "|---" * (3 + 2 * len(ways)) + "|",
    ]
    for row in found:
        cells = [
            f"{values[way]:.2f}" if way in values else ""
            for values in (row.seconds, row.times)
            for way in ways
        ]
        lines.append(f"| {row.scene} | {row.triangles:,} | {row.embree:.2f} | {' | '.join(cells)} |")
    return "\n".join(lines), [row.row() for row in found]


def run_ablate(arguments: argparse.Namespace) -> tuple[str, Any]:
    """Two or more builds of the compiled core."""
    from .ablation import ablate

    rows = [
        ablate(scene, arguments.cores, arguments.size, arguments.spp, arguments.repeats, arguments.threads)
        for scene in arguments.scenes
    ]
    lines = ["| scene | speed over the first build | same picture |", "|---|---|---|"]
    for row in rows:
        ratios = ", ".join(
            f"{m:.3f} ({a:.3f} to {b:.3f})"
            for m, a, b in zip(row["speed_over_first"], row["least"], row["most"], strict=True)  # type: ignore[call-overload]
        )
        lines.append(f"| {row['scene']} | {ratios} | {row['same_picture']} |")
    return "\n".join(lines), rows


def parser() -> argparse.ArgumentParser:
    """What can be asked for."""
    common = argparse.ArgumentParser(add_help=False)
    common.add_argument("--scenes", nargs="+", choices=NAMES, metavar="SCENE", help=", ".join(NAMES))
    common.add_argument("--size", type=int, help="pixels along each side")
    common.add_argument("--spp", type=int, help="samples a pixel, at least 2")
    common.add_argument("--repeats", type=int, help="how many turns each takes, at least 2")
    common.add_argument("--threads", type=int, default=os.cpu_count(), help="of each renderer")
    common.add_argument(
        "--quick", action="store_true", help=f"{', '.join(QUICK)}; 256 x 256, 16 spp, 3 repeats"
    )
    common.add_argument("--json", type=Path, metavar="FILE", help="write the results there as well")
    main = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    commands = main.add_subparsers(dest="command", required=True)
    compare = commands.add_parser(
        "compare",
        parents=[common],
        help="Étendue, Mitsuba 3, Cycles and LuxCore on the same scenes, in alternation",
    )
    names = tuple(contestants.CONTESTANTS)
    compare.add_argument(
        "--renderers", nargs="+", choices=names, default=names, metavar="NAME", help=", ".join(names)
    )
    compare.add_argument(
        "--settings",
        choices=("matched", "users"),
        default="matched",
        help="matched: box filter, no roulette, equal path length; users: each renderer's defaults",
    )
    compare.add_argument(
        "--uncoated",
        action="store_true",
        help="coated materials without their coats, as no two renderers agree on them",
    )
    compare.set_defaults(run=run_compare)
    limit = commands.add_parser(
        "limit", parents=[common], help="a render against the bare tracing of its own rays"
    )
    limit.set_defaults(run=run_limit)
    ablate = commands.add_parser(
        "ablate", parents=[common], help="builds of the compiled core against the first"
    )
    ablate.add_argument("cores", nargs="+", type=Path, help="files _core*.so")
    ablate.set_defaults(run=run_ablate)
    load = commands.add_parser(
        "load", parents=[common], help="loading a scene, beside Embree's build over its triangles alone"
    )
    load.set_defaults(run=run_load)
    startup = commands.add_parser(
        "startup", parents=[common], help="the time to import, and of a tiny render"
    )
    startup.set_defaults(run=run_startup)
    install = commands.add_parser(
        "install-peers", help=f"a virtual environment with the peers, in {contestants.PEERS.name}"
    )
    install.set_defaults(run=None)
    return main


def main() -> None:
    """Measures, prints a table, writes JSON."""
    arguments = parser().parse_args()
    if arguments.command == "install-peers":
        contestants.install_peers()
        return
    full = not arguments.quick
    arguments.scenes = arguments.scenes or (NAMES if full else QUICK)
    arguments.size = arguments.size or (512 if full else 256)
    arguments.spp = arguments.spp or 16
    arguments.repeats = arguments.repeats or (5 if full else 3)
    if arguments.spp < 2 or arguments.repeats < 2:
        raise SystemExit("benchmarks: --spp and --repeats must be 2 or more")
    about = machine() | {
        key: str(value) if isinstance(value, Path) else value
        for key, value in vars(arguments).items()
        if key not in ("run", "json", "cores")
    }
    run: Callable[[argparse.Namespace], tuple[str, Any]] = arguments.run
    text, rows = run(arguments)
    print(f"\n{about['date']} UTC, {about['cores']} cores, {about['processor']}\n\n{text}")
    if arguments.json:
        arguments.json.write_text(json.dumps({"about": about, "results": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
