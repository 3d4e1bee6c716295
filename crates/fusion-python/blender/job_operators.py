"""Operators that run one operation and put its result into a new object."""

import bpy
import numpy as np

from . import edges, gather, problems, snapshot
from .operation import Operation, Request, offer, selected


class FUSION_OT_remesh(Operation, bpy.types.Operator):
    bl_idname = "fusion.remesh"
    bl_label = "Remesh"

    def request(self, context):
        return Request("remesh", selected(context)[:1], self.given())


class FUSION_OT_sharpen(Operation, bpy.types.Operator):
    bl_idname = "fusion.sharpen"
    bl_label = "Sharpen Fillet"

    def request(self, context):
        request = Request("sharpen", selected(context)[:1], self.given())
        at_cursor = [gather.cursor(context, request.frame)[0]]
        request.options["near"] = gather.picked(request.things[0], request.frame) if self.picked else at_cursor
        if not request.options["near"]:
            raise problems.Problem("no vertex is selected", remedy="Select a vertex on each fillet, or use the 3D cursor")
        return request


class FUSION_OT_cut(Operation, bpy.types.Operator):
    bl_idname = "fusion.cut"
    bl_label = "Cut"

    def request(self, context):
        request = Request("cut", selected(context)[:1], self.given())
        if self.by == "CURSOR":
            place, normal = gather.cursor(context, request.frame)
            request.options["plane"] = {"point": place, "normal": normal}
            return request
        path = gather.picked(request.things[0], request.frame)
        if len(path) < 2:
            raise problems.Problem(
                f"{len(path)} vertices are selected; a path takes two or more",
                remedy="Select vertices along the cut, one after the other, in edit mode",
            )
        request.options["path"] = path
        return request


class FUSION_OT_cluster(Operation, bpy.types.Operator):
    bl_idname = "fusion.cluster"
    bl_label = "Cluster Polyhedron"

    def request(self, context):
        return Request("cluster", selected(context)[:1], self.given(), polygons=True)


class FUSION_OT_compose(Operation, bpy.types.Operator):
    bl_idname = "fusion.compose"
    bl_label = "Compose Openings"
    least = 1

    def request(self, context):
        pens = [thing for thing in context.selected_objects if thing.type in gather.STROKES]
        parts = [thing for thing in selected(context) if thing not in pens]
        if not parts:
            raise problems.Problem("no open mesh is selected", remedy="Select the meshes whose openings are to be joined")
        request = Request("compose", parts, self.given())
        found = gather.strokes(pens, request.frame)
        if found:
            seen = gather.view_direction(context)
            view = gather.turned(request.frame, self.view if seen is None or not self.from_view else seen)
            request.options["silhouette"] = [{"view": view, "stroke": stroke} for stroke in found]
        return request


class FUSION_OT_detail(Operation, bpy.types.Operator):
    bl_idname = "fusion.detail"
    bl_label = "Transfer Detail"

    def request(self, context):
        things = selected(context)[:2]
        request = Request("detail", things[:1], self.given())
        request.options["target"] = {"faces": gather.group_faces(request.surfaces[0], self.target)}
        if len(things) == 1:
            request.options["source"] = {"faces": gather.group_faces(request.surfaces[0], self.source)}
            return request
        other = Request("detail", things)
        points, faces = other.stack.part(1)
        region = {"faces": gather.group_faces(other.surfaces[1], self.source), "mesh": (points, faces)}
        request.options["source"] = region
        return request


class FUSION_OT_max_radius(Operation, bpy.types.Operator):
    """Find the largest radius of the edges of one object, or of the seams of several"""

    bl_idname = "fusion.max_radius"
    bl_label = "Largest Radius"
    operation, extra = "blend", ("edges", "boolean")

    edges: bpy.props.EnumProperty(
        name="Edges",
        items=[
            ("ANGLE", "By angle", "All edges whose faces turn by at least 40 degrees"),
            ("SELECTED", "Selected", "The edges selected in edit mode"),
        ],
    )
    boolean: bpy.props.EnumProperty(
        name="Seams of",
        items=[("union", "Union", ""), ("difference", "Difference", ""), ("intersection", "Intersection", "")],
    )

    def draw(self, _context):
        for name in self.extra:
            self.layout.prop(self, name)

    def request(self, context):
        things = selected(context)
        active = things[0]
        if active.fusion.kind != "NONE":
            taken = snapshot.take(active)
            request = Request("max_radius", snapshot.sources(active), taken.options)
            request.options.pop("radius", None)
            if active.fusion.kind == "BOOLEAN":
                request.options["operation"] = taken.function
            return request
        request = Request("max_radius", things)
        if len(things) > 1:
            request.options["operation"] = self.boolean
        elif self.edges == "SELECTED":
            marked = edges.marked(request.surfaces[0], "SELECTED")
            if not marked.any():
                raise problems.Problem("no edge is selected", remedy="Select edges in edit mode")
            request.options["curves"] = edges.curves(request.stack, marked)
        return request

    def finish(self, context, made, request):
        context.window_manager.fusion_largest_radius = made.radius
        if made.at is not None:
            context.scene.cursor.location = (np.array(request.frame) @ [*made.at, 1.0])[:3]
        self.report({"INFO"}, f"largest radius {made.radius:.6g}: {made.limited_by}")


offer(FUSION_OT_remesh, "remesh")
offer(
    FUSION_OT_sharpen,
    "sharpen",
    picked=bpy.props.BoolProperty(
        name="Selected Vertices", description="The fillets at the selected vertices; else that at the 3D cursor"
    ),
)
offer(
    FUSION_OT_cut,
    "cut",
    by=bpy.props.EnumProperty(
        name="By",
        items=[
            ("CURSOR", "Cursor Plane", "The plane across the Z axis of the 3D cursor; what lies beyond goes"),
            ("PICKED", "Picked Vertices", "A closed path through the selected vertices"),
        ],
    ),
)
offer(FUSION_OT_cluster, "cluster")
offer(
    FUSION_OT_compose,
    "compose",
    from_view=bpy.props.BoolProperty(
        name="As Seen", description="Strokes are drawn as the 3D view looks", default=True
    ),
    view=bpy.props.FloatVectorProperty(
        name="View", description="Where the view of the strokes looks, if not the 3D view's", default=(0.0, 1.0, 0.0)
    ),
)
offer(
    FUSION_OT_detail,
    "detail",
    target=bpy.props.StringProperty(name="Target", description="Vertex group of the smooth region", default="target"),
    source=bpy.props.StringProperty(name="Source", description="Vertex group that has the detail", default="source"),
)

CLASSES = (
    FUSION_OT_cut,
    FUSION_OT_compose,
    FUSION_OT_detail,
    FUSION_OT_sharpen,
    FUSION_OT_cluster,
    FUSION_OT_remesh,
    FUSION_OT_max_radius,
)


def register():
    bpy.types.WindowManager.fusion_largest_radius = bpy.props.FloatProperty(name="Largest Radius", unit="LENGTH")
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
    del bpy.types.WindowManager.fusion_largest_radius
