"""The panel in the sidebar of the 3D view."""

import bpy

from . import job_operators, live, options, settings


class FUSION_PT_live(bpy.types.Panel):
    """Live objects."""

    bl_label = "Live Objects"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Fusion"

    def draw(self, context):
        layout = self.layout
        row = layout.row(align=True)
        row.operator("fusion.add_boolean")
        row.operator("fusion.add_blend")
        running = live.progress()
        if running is not None:
            row = layout.row()
            row.progress(factor=running[1], text=running[0])
            row.operator("fusion.cancel", text="", icon="X")
        thing = context.active_object
        if thing is not None and thing.fusion.kind != "NONE":
            _draw_live(layout, thing.fusion)


def _draw_live(layout, group):
    row = layout.row(align=True)
    row.prop(group, "is_live", toggle=True)
    row.operator("fusion.update", text="", icon="FILE_REFRESH")
    row.operator("fusion.bake")
    row.operator("fusion.remove", text="", icon="TRASH")
    if group.message:
        box = layout.box()
        for line in group.message.splitlines():
            box.label(text=line, icon="ERROR" if group.is_error else "INFO")
        if group.remedy:
            box.label(text=group.remedy)
        if group.workable > 0:
            box.operator("fusion.apply_remedy", text=f"Use radius {group.workable:.4g}")
    column = layout.column(align=True)
    for index, entry in enumerate(group.sources):
        row = column.row(align=True)
        row.prop(entry, "object", text=str(index))
        row.operator("fusion.remove_source", text="", icon="REMOVE").index = index
    column.operator("fusion.add_source")
    column = layout.column()
    column.use_property_split = True
    if group.kind == "BOOLEAN":
        column.prop(group, "operation")
        options.draw(column, "boolean", group.boolean, settings.BOOLEAN_WITHOUT)
    else:
        column.prop(group, "edges")
        if group.edges == "CUSTOM":
            column.prop(group, "attribute")
        options.draw(column, "blend", group.blend, settings.BLEND_WITHOUT)
    column.prop(group, "material")


class FUSION_PT_jobs(bpy.types.Panel):
    """Operations that make a new object."""

    bl_label = "Operations"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Fusion"

    def draw(self, _context):
        column = self.layout.column(align=True)
        for one in job_operators.CLASSES:
            column.operator(one.bl_idname)


_CLASSES = (FUSION_PT_live, FUSION_PT_jobs)


def register():
    for one in _CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
