"""Operators that make, renew and end live objects."""

import bpy

from . import live, problems, settings, snapshot
from .surface import KINDS


def _surfaces(context):
    """The selected objects with a surface, the active one first."""
    active = context.active_object
    others = [thing for thing in context.selected_objects if thing != active]
    return [thing for thing in [active, *others] if thing is not None and thing.type in KINDS]


def _new(context, kind, name, sources, as_wire):
    thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    context.collection.objects.link(thing)
    thing.fusion.kind = kind
    for source in sources:
        entry = thing.fusion.sources.add()
        entry.object = source
        entry.display, entry.was_rendered = "", not source.hide_render
        if as_wire:
            entry.display = source.display_type
            source.display_type, source.hide_render = "WIRE", True
    for other in context.selected_objects:
        other.select_set(False)
    thing.select_set(True)
    context.view_layer.objects.active = thing
    return thing


def _restore(thing):
    """Shows the sources as they were."""
    for entry in thing.fusion.sources:
        if entry.object is not None and entry.display:
            entry.object.display_type = entry.display
            entry.object.hide_render = not entry.was_rendered


def _done(operator, thing):
    """Makes the first result at once, so that undo has it, and tells what there is to tell."""
    bpy.context.view_layer.update()
    live.request(thing)
    live.complete()
    return _told(operator, thing)


def _told(operator, thing):
    if thing.fusion.message:
        operator.report({"ERROR" if thing.fusion.is_error else "WARNING"}, thing.fusion.message)
    return {"FINISHED"}


class _Live:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        thing = context.active_object
        return thing is not None and thing.mode == "OBJECT" and thing.fusion.kind != "NONE"


class FUSION_OT_add_boolean(bpy.types.Operator):
    """Make an object that stays the boolean of the selected ones, with fillets on its seams. The active one is the first"""

    bl_idname = "fusion.add_boolean"
    bl_label = "Fusion Boolean"
    bl_options = {"REGISTER", "UNDO"}

    operation: bpy.props.EnumProperty(name="Operation", items=settings.OPERATIONS)
    radius: bpy.props.FloatProperty(
        name="Radius", description="Radius of the fillets; 0 leaves the seams sharp", min=0.0, default=0.1, unit="LENGTH"
    )
    as_wire: bpy.props.BoolProperty(
        name="Sources as Wire", description="Show the sources as wire, and do not render them", default=True
    )

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and len(_surfaces(context)) > 1

    def execute(self, context):
        thing = _new(context, "BOOLEAN", "Fusion Boolean", _surfaces(context), self.as_wire)
        thing.fusion.operation = self.operation
        thing.fusion.boolean.use_radius = self.radius > 0
        if self.radius > 0:
            thing.fusion.boolean.radius = self.radius
        return _done(self, thing)


class FUSION_OT_add_blend(bpy.types.Operator):
    """Make an object that stays the active one with blended edges"""

    bl_idname = "fusion.add_blend"
    bl_label = "Fusion Blend"
    bl_options = {"REGISTER", "UNDO"}

    edges: bpy.props.EnumProperty(name="Edges", items=settings.EDGES)
    attribute: bpy.props.StringProperty(name="Attribute", description="Edges on which this attribute is not 0")
    radius: bpy.props.FloatProperty(name="Radius", description="Radius of the blend", min=0.0, default=0.1, unit="LENGTH")
    as_wire: bpy.props.BoolProperty(
        name="Source as Wire", description="Show the source as wire, and do not render it", default=True
    )

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and context.active_object is not None and context.active_object.type in KINDS

    def execute(self, context):
        thing = _new(context, "BLEND", "Fusion Blend", [context.active_object], self.as_wire)
        thing.fusion.edges, thing.fusion.attribute = self.edges, self.attribute
        thing.fusion.blend.use_radius = True
        thing.fusion.blend.radius = self.radius
        return _done(self, thing)


class FUSION_OT_update(_Live, bpy.types.Operator):
    """Make the live object again"""

    bl_idname = "fusion.update"
    bl_label = "Update"

    def execute(self, context):
        thing = context.active_object
        snapshot.forget()
        thing.fusion.key = ""
        return _done(self, thing)


class FUSION_OT_bake(_Live, bpy.types.Operator):
    """Make the live object a plain mesh, and show its sources as they were"""

    bl_idname = "fusion.bake"
    bl_label = "Bake"

    def execute(self, context):
        thing = context.active_object
        live.request(thing)
        live.complete()
        if thing.fusion.is_error:
            self.report({"ERROR"}, thing.fusion.message)
            return {"CANCELLED"}
        problems.clear(thing)
        _restore(thing)
        thing.fusion.sources.clear()
        thing.fusion.kind, thing.fusion.key = "NONE", ""
        return {"FINISHED"}


class FUSION_OT_remove(_Live, bpy.types.Operator):
    """Delete the live object, and show its sources as they were"""

    bl_idname = "fusion.remove"
    bl_label = "Remove"

    def execute(self, context):
        thing = context.active_object
        problems.clear(thing)
        _restore(thing)
        mesh = thing.data
        bpy.data.objects.remove(thing)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)
        return {"FINISHED"}


class FUSION_OT_add_source(_Live, bpy.types.Operator):
    """Add the selected objects to the sources of the active live object"""

    bl_idname = "fusion.add_source"
    bl_label = "Add Selected"

    def execute(self, context):
        thing = context.active_object
        had = [entry.object for entry in thing.fusion.sources]
        for other in context.selected_objects:
            if other != thing and other not in had and other.type in KINDS:
                entry = thing.fusion.sources.add()
                entry.object = other
        return _done(self, thing)


class FUSION_OT_remove_source(_Live, bpy.types.Operator):
    """Take a source away from the active live object"""

    bl_idname = "fusion.remove_source"
    bl_label = "Remove Source"

    index: bpy.props.IntProperty(name="Index", min=0)

    def execute(self, context):
        thing = context.active_object
        if self.index >= len(thing.fusion.sources):
            self.report({"ERROR"}, f"there is no source {self.index}")
            return {"CANCELLED"}
        thing.fusion.sources.remove(self.index)
        return _done(self, thing)


class FUSION_OT_apply_remedy(_Live, bpy.types.Operator):
    """Use the largest radius that was found to work"""

    bl_idname = "fusion.apply_remedy"
    bl_label = "Use Working Radius"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.active_object.fusion.workable > 0

    def execute(self, context):
        thing = context.active_object
        group = thing.fusion.options_of()
        group.use_radius, group.radius_in = True, "UNITS"
        group.radius = thing.fusion.workable
        return _done(self, thing)


class FUSION_OT_cancel(bpy.types.Operator):
    """Stop the jobs that run; live objects stay as they are until the next change"""

    bl_idname = "fusion.cancel"
    bl_label = "Stop"

    def execute(self, _context):
        live.cancel()
        return {"FINISHED"}


_CLASSES = (
    FUSION_OT_add_boolean,
    FUSION_OT_add_blend,
    FUSION_OT_update,
    FUSION_OT_bake,
    FUSION_OT_remove,
    FUSION_OT_add_source,
    FUSION_OT_remove_source,
    FUSION_OT_apply_remedy,
    FUSION_OT_cancel,
)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
