"""Blender properties of an operation's options, made from `options.json`, which `cargo xtask blender` writes from the schema."""

import json
import os

import bpy
import numpy as np

with open(os.path.join(os.path.dirname(__file__), "options.json"), encoding="utf-8") as _file:
    _OPERATIONS = json.load(_file)

_HUGE = 1e9


def summary(operation):
    """What an operation does, as one sentence."""
    return _OPERATIONS[operation]["summary"]


def names(operation):
    """The options that have a property, those most used first."""
    return [option["name"] for option in _OPERATIONS[operation]["options"]]


def annotations(operation, update=None, without=()):
    """Properties for a class's `__annotations__`. An option without a default has a second one that turns it on."""
    made = {}
    for option in _OPERATIONS[operation]["options"]:
        name = option["name"]
        if name in without:
            continue
        made[name] = _property(option, update)
        if option["optional"]:
            label = f"Set {_label(name)}"
            made[f"use_{name}"] = bpy.props.BoolProperty(name=label, description=option["meaning"], update=update)
        if option["kind"] == "length":
            made[f"{name}_in"] = bpy.props.EnumProperty(
                name=f"{_label(name)} in",
                items=[
                    ("UNITS", "Units", "Scene units"),
                    ("PERCENT", "%", "Percent of the diagonal of the box around all inputs"),
                ],
                update=update,
            )
            made[f"{name}_percent"] = bpy.props.FloatProperty(
                name=_label(name), description=option["meaning"], min=0.0, soft_max=100.0, default=2.0, update=update
            )
    return made


def values(operation, holder, without=()):
    """The options as the engine takes them; those that are not set are missing."""
    given = {}
    for option in _OPERATIONS[operation]["options"]:
        name, kind = option["name"], option["kind"]
        if name in without or (option["optional"] and not getattr(holder, f"use_{name}")):
            continue
        value = getattr(holder, name)
        if kind == "length" and getattr(holder, f"{name}_in") == "PERCENT":
            value = f"{exact(getattr(holder, f'{name}_percent'))}%"
        elif kind in ("number", "length"):
            value = exact(value)
        given[name] = value
    return given


def exact(value):
    """The shortest decimal number that a 32-bit property holds as this: 0.1, not 0.10000000149."""
    return float(str(np.float32(value)))


def draw(layout, operation, holder, without=()):
    """A row for each option."""
    for option in _OPERATIONS[operation]["options"]:
        name = option["name"]
        if name in without:
            continue
        row = layout.row(align=True)
        is_set = True
        if option["optional"]:
            row.prop(holder, f"use_{name}", text="")
            is_set = getattr(holder, f"use_{name}")
        values_row = row.row(align=True)
        values_row.active = is_set
        if option["kind"] == "length":
            percent = getattr(holder, f"{name}_in") == "PERCENT"
            values_row.prop(holder, f"{name}_percent" if percent else name)
            values_row.prop(holder, f"{name}_in", text="")
        else:
            values_row.prop(holder, name)


def _label(name):
    return name.replace("_", " ").capitalize()


def _property(option, update):
    common = {"name": _label(option["name"]), "description": option["meaning"], "update": update}
    kind, default = option["kind"], option["default"]
    least, most = option.get("minimum", -_HUGE), option.get("maximum", _HUGE)
    if kind == "length":
        return bpy.props.FloatProperty(default=0.1, min=0.0, unit="LENGTH", precision=4, **common)
    if kind == "number":
        value = least if default is None else default
        return bpy.props.FloatProperty(default=value, min=least, max=most, precision=4, **common)
    if kind == "integer":
        value = int(least if default is None else default)
        return bpy.props.IntProperty(default=value, min=int(least), max=int(min(most, 2**31 - 1)), **common)
    if kind == "bool":
        return bpy.props.BoolProperty(default=bool(default), **common)
    items = [(word, word.capitalize(), meaning) for word, meaning in option["words"]]
    return bpy.props.EnumProperty(items=items, default=default or items[0][0], **common)
