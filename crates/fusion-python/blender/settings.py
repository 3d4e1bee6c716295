"""What a live object remembers: its sources, its options, and what there is to tell."""

import bpy

from . import options

# Options that come from the scene, not from a number: which function, and which edges.
BOOLEAN_WITHOUT = ("operation",)
BLEND_WITHOUT = ()


def _changed(self, _context):
    thing = self.id_data
    # A change of a property of ours is no change for Blender.
    thing.fusion.is_stale = True
    thing.update_tag()


class FusionSource(bpy.types.PropertyGroup):
    """An object that a live object is made of, and how it was shown before."""

    object: bpy.props.PointerProperty(type=bpy.types.Object, update=_changed)
    display: bpy.props.StringProperty()
    was_rendered: bpy.props.BoolProperty()


class FusionBooleanOptions(bpy.types.PropertyGroup):
    """Options of a live boolean."""

    __annotations__ = options.annotations("boolean", _changed, BOOLEAN_WITHOUT)


class FusionBlendOptions(bpy.types.PropertyGroup):
    """Options of a live blend."""

    __annotations__ = options.annotations("blend", _changed, BLEND_WITHOUT)


KINDS = [
    ("NONE", "None", "Not a live object"),
    ("BOOLEAN", "Fusion Boolean", "A boolean with filleted seams"),
    ("BLEND", "Fusion Blend", "Edges blended by a rolling ball"),
]
OPERATIONS = [
    ("difference", "Difference", "What is in the first source and in no other"),
    ("union", "Union", "What is in any source"),
    ("intersection", "Intersection", "What is in every source"),
]
EDGES = [
    ("ANGLE", "By angle", "All edges whose faces turn by at least the angle"),
    ("SELECTED", "Selected", "The edges that are selected in the source's edit mode"),
    ("sharp_edge", "Marked sharp", "Edges marked sharp"),
    ("uv_seam", "Marked as seam", "Edges marked as UV seam"),
    ("crease_edge", "Creased", "Edges with a crease"),
    ("bevel_weight_edge", "Bevel weight", "Edges with a bevel weight"),
    ("CUSTOM", "Attribute", "Edges on which the named attribute is not 0"),
]


class FusionObject(bpy.types.PropertyGroup):
    """The settings of an object of ours."""

    kind: bpy.props.EnumProperty(items=KINDS)
    is_live: bpy.props.BoolProperty(
        name="Live", description="Follow the sources", default=True, update=_changed, options=set()
    )
    is_stale: bpy.props.BoolProperty(options={"HIDDEN"})
    sources: bpy.props.CollectionProperty(type=FusionSource)
    operation: bpy.props.EnumProperty(name="Operation", items=OPERATIONS, update=_changed)
    boolean: bpy.props.PointerProperty(type=FusionBooleanOptions)
    edges: bpy.props.EnumProperty(name="Edges", items=EDGES, update=_changed)
    attribute: bpy.props.StringProperty(
        name="Attribute", description="Blend edges on which this attribute is not 0", update=_changed
    )
    blend: bpy.props.PointerProperty(type=FusionBlendOptions)
    material: bpy.props.PointerProperty(
        name="Material", description="Material of new faces", type=bpy.types.Material, update=_changed
    )
    key: bpy.props.StringProperty(options={"HIDDEN"})
    message: bpy.props.StringProperty(options={"HIDDEN"})
    is_error: bpy.props.BoolProperty(options={"HIDDEN"})
    remedy: bpy.props.StringProperty(options={"HIDDEN"})
    workable: bpy.props.FloatProperty(options={"HIDDEN"})
    marker: bpy.props.PointerProperty(type=bpy.types.Object)

    def options_of(self):
        """The group of options that belongs to the kind."""
        return self.boolean if self.kind == "BOOLEAN" else self.blend


_CLASSES = (FusionSource, FusionBooleanOptions, FusionBlendOptions, FusionObject)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Object.fusion = bpy.props.PointerProperty(type=FusionObject)


def unregister():
    del bpy.types.Object.fusion
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
