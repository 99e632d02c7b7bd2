# SPDX-License-Identifier: Apache-2.0
"""The source paper's own figures, from our data: levels of the tree, links of two buildings and a street piece, pictures after
0 to 3 sweeps, and the paper's measure of convergence beside the residual."""
import numpy as np

import drawing
from pack_file import Pack
from plots import save
from scenes import DHI, DNI
from tables import read_csv

LIGHT = ["--sun", "150,40", "--dni", DNI, "--dhi", DHI]
SWEEPS = 8


def convergence(programs, pack, say):
    """Per sweep: the paper's E_i = sqrt(sum (B^i - B^(i-1))^2) over patches, broadband, and the solver's residual. And the
    area-weighted relative distance of E_indirect from that of the last sweep's double."""
    patches = Pack(pack).patches()
    table = programs.work / "sweep.csv"

    def light_after(sweeps):
        solved = programs.render(pack, [*LIGHT, "--iterations", sweeps, "--table", table])
        return read_csv(table), solved["residual"]

    final, _ = light_after(2 * SWEEPS)
    area, truth = final["area"], final["E_indirect_solar"]
    before, rows = None, []
    for sweep in range(1, SWEEPS + 1):
        columns, residual = light_after(sweep)
        if before is None:
            before = patches["emission"][:, 3] + patches["rho"][:, 3] * (columns["E_sun_solar"] + columns["E_sky_solar"])
        d = columns["E_indirect_solar"] - truth
        rows.append({"sweep": sweep, "E_i": float(np.sqrt(((columns["B_solar"] - before) ** 2).sum())),
                     "residual": residual,
                     "error": float(np.sqrt((area * d ** 2).sum() / area.sum()) / ((area * truth).sum() / area.sum()))})
        before = columns["B_solar"]
    say("  E_i by sweep: " + ", ".join(f"{row['E_i']:.3g}" for row in rows))
    return rows


def sweep_pictures(programs, scene, pack, output, say):
    """Pictures after 0, 1, 2 and 3 sweeps at one exposure. 0 sweeps: the paper's method as printed, with a threshold below
    which no link falls, has no links, so its picture is that of first-hand light."""
    import mitsuba as mi
    mi.set_variant("scalar_rgb")
    dark = programs.work / "dark.pack"
    programs.bake(dark, scene.inputs, ["--method", "paper-literal", "--epsilon", 1e-6, "--cutoff", 0.001])
    figure, axes = drawing.plt.subplots(2, 4, figsize=(16, 5.6), layout="constrained")
    for row, (view, title) in enumerate((("final", "picture"), ("eindirect", "E_indirect"))):
        pictures = []
        for sweeps in range(4):
            picture = programs.work / f"sweeps-{view}-{sweeps}.exr"
            programs.render(dark if sweeps == 0 else pack,
                            [*LIGHT, "--iterations", max(sweeps, 1), "--view", view, "--exr", picture, "--size", "640x400",
                             "--samples", 2 if view == "final" else 1])
            pictures.append(np.array(mi.Bitmap(str(picture)))[..., :3].astype(float))
        white = np.percentile(pictures[3], 97)
        for sweeps, picture in enumerate(pictures):
            axis = axes[row][sweeps]
            if view == "final":
                axis.imshow(np.clip(picture / white, 0, 1) ** (1 / 2.2))
            else:
                shown = axis.imshow(picture.mean(axis=-1), cmap="viridis", vmin=0, vmax=white)
            axis.set_title(f"{title}, {sweeps} sweep{'s' * (sweeps != 1)}", fontsize=10)
            axis.axis("off")
    figure.colorbar(shown, ax=axes, fraction=0.015, label="E_indirect, W/m2")
    return save(figure, output, f"sweeps_{scene.name}")


def measure(programs, scenes, options, data, say):
    result = {}
    for scene in [s for s in scenes if s.name in ("S", "prague")]:
        say(f"{scene.title}: the paper's figures")
        pack = programs.work / f"{scene.name}.pack"
        programs.bake(pack, scene.inputs, [])
        tile = Pack(pack)
        leaves = drawing.Leaves(tile)
        building = drawing.typical_building(leaves)
        entry = result[scene.name] = {"title": scene.title}
        figure, entry["levels"] = drawing.tree_figure(leaves, building)
        entry["tree"] = save(figure, options.output, f"tree_{scene.name}")
        figure, entry["link_counts"] = drawing.links_figure(leaves, tile.links(), building,
                                                            drawing.neighbours_of(leaves, building))
        entry["links"] = save(figure, options.output, f"links_{scene.name}")
        entry["sweeps"] = sweep_pictures(programs, scene, pack, options.output, say)
        entry["convergence"] = convergence(programs, pack, say)
    return result
