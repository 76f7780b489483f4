#!/usr/bin/env python3
"""Builds the conda package and runs its tests where no channel can be reached: with the compilers, tools and headers of
this system in place of those that the recipe requires. It needs rattler-build from PyPI (py-rattler-build), and PyYAML.

    build.py FOLDER    the channel in which the package is put
"""

import pathlib
import sys

import rattler_build
import yaml

folder = pathlib.Path(sys.argv[1]).resolve()
here = pathlib.Path(__file__).resolve().parent
recipe = yaml.safe_load((here / "recipe.yaml").read_text())
for part in (recipe, *recipe["tests"]):
    del part["requirements"]
recipe["source"]["path"] = str(here.parents[1])
for script in ("build.sh", "test.sh"):
    # The recipe without requirements lies elsewhere.
    (folder / "recipe").mkdir(parents=True, exist_ok=True)
    (folder / "recipe" / script).write_bytes((here / script).read_bytes())
stage0 = rattler_build.Stage0Recipe.from_dict(recipe, recipe_dir=folder / "recipe")
for result in stage0.run_build(
    tool_config=rattler_build.ToolConfiguration(test_strategy="native"), output_dir=folder, channels=[]
):
    print(result.packages)
