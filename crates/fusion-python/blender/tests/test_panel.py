"""The panel shows properties and operators that exist, and properties have the defaults of the engine."""

import importlib
import inspect
import json
import pathlib
import types

import bpy
from harness import NAME, boolean, cube, cylinder, run, select, update


class Layout:
    """Stands for Blender's layout, and looks whether what it is to show is there."""

    def __init__(self):
        self.shown, self.use_property_split, self.active = [], False, True

    def row(self, **_):
        return self

    column = box = row

    def prop(self, holder, name, **_):
        assert name in holder.bl_rna.properties, name
        self.shown.append(name)

    def operator(self, name, **_):
        group, operator = name.split(".")
        assert operator in dir(getattr(bpy.ops, group)), name
        self.shown.append(name)
        return types.SimpleNamespace()

    def label(self, text="", **_):
        self.shown.append(text)

    def progress(self, **_):
        pass


def drawn(panel):
    layout = Layout()
    getattr(importlib.import_module(f"{NAME}.panel"), panel).draw(types.SimpleNamespace(layout=layout), bpy.context)
    return layout.shown


def test_panels_show_what_is_there():
    assert drawn("FUSION_PT_live") == ["fusion.add_boolean", "fusion.add_blend"]
    assert len(drawn("FUSION_PT_jobs")) == 7
    block, drill = cube(), cylinder(radius=0.3)
    result = boolean(block, drill, radius=0.1)
    shown = drawn("FUSION_PT_live")
    assert {"radius", "profile", "overlap", "tolerance", "operation", "material"} <= set(shown)
    assert shown.count("object") == 2
    result.fusion.boolean.overlap, result.fusion.boolean.radius = "error", 0.9
    update()
    assert "fusion.apply_remedy" in drawn("FUSION_PT_live")
    select(block)
    bpy.ops.fusion.add_blend(radius=0.1)
    assert {"edges", "angle", "chain"} <= set(drawn("FUSION_PT_live"))


def test_defaults_are_those_of_the_engine():
    import fusion_mesh as fm

    options = importlib.import_module(f"{NAME}.options")
    path = pathlib.Path(options.__file__).with_name("options.json")
    for operation, functions in {"boolean": ("difference",), "blend": ("blend",)}.items():
        thing = bpy.data.objects.new("thing", None)
        given = options.values(operation, getattr(thing.fusion, operation), ("operation",))
        for function in functions:
            taken = inspect.signature(getattr(fm, function)).parameters
            assert given and all(taken[name].default == value for name, value in given.items()), given
    for operation, entry in json.loads(path.read_text(encoding="utf-8")).items():
        function = getattr(fm, {"boolean": "union"}.get(operation, operation))
        known = inspect.signature(function).parameters
        for option in entry["options"]:
            if option["name"] != "operation":
                default = known[option["name"]].default if option["name"] in known else None
                assert option["name"] in known or operation == "blend", (operation, option["name"])
                assert default is None or option["default"] == default, (operation, option["name"])


def test_lengths_in_percent_and_exact_numbers():
    options = importlib.import_module(f"{NAME}.options")
    thing = bpy.data.objects.new("thing", None)
    group = thing.fusion.boolean
    assert "radius" not in options.values("boolean", group, ("operation",))
    group.use_radius, group.radius = True, 0.1
    assert options.values("boolean", group, ("operation",))["radius"] == 0.1
    group.radius_in, group.radius_percent = "PERCENT", 2.5
    assert options.values("boolean", group, ("operation",))["radius"] == "2.5%"


run(globals())
