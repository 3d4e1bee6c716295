"""Operators that run one operation and put its result into a new object."""

import bpy
import numpy as np
from mathutils import Matrix

from . import build, gather, options, problems, snapshot
from .engine import Job
from .stack import stack
from .surface import KINDS

_INTERVAL = 0.05


class Request:
    """Which function of the engine on which objects."""

    def __init__(self, function, things, given=None, polygons=False):
        self.things = things
        self.surfaces = [s for s, _ in snapshot.surfaces_of(things)]
        self.frame, matrices = snapshot.frame_of(things)
        self.stack = stack(self.surfaces, matrices)
        self.function, self.options, self.polygons = function, dict(given or {}), polygons

    def start(self):
        """The job in its thread."""
        return Job(self.function, self.stack, self.options, self.polygons)


class _Operation:
    """Runs in a thread: at once in a script, and with the mouse free, progress shown and Esc to stop in the window."""

    bl_options = {"REGISTER", "UNDO"}
    least = 1

    @classmethod
    def poll(cls, context):
        return context.mode in {"OBJECT", "EDIT_MESH"} and len(_selected(context)) >= cls.least

    def execute(self, context):
        try:
            request = self.request(context)
        except problems.Problem as problem:
            return self._failed(problem)
        job = request.start()
        job.wait()
        return self._ended(context, job, request)

    def invoke(self, context, _event):
        try:
            self._asked = self.request(context)
        except problems.Problem as problem:
            return self._failed(problem)
        self._job = self._asked.start()
        self._timer = context.window_manager.event_timer_add(_INTERVAL, window=context.window)
        context.window_manager.modal_handler_add(self)
        context.window_manager.progress_begin(0, 100)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._job.cancel()
            self._close(context)
            self.report({"INFO"}, "stopped")
            return {"CANCELLED"}
        if event.type != "TIMER" or not self._job.is_done:
            context.window_manager.progress_update(int(100 * self._job.share))
            return {"RUNNING_MODAL"} if event.type == "TIMER" else {"PASS_THROUGH"}
        self._close(context)
        return self._ended(context, self._job, self._asked)

    def cancel(self, context):
        self._job.cancel()
        self._close(context)

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        for name in self.extra:
            layout.prop(self, name)
        options.draw(layout, self.operation, self, self.without)

    extra = ()
    without = ()

    def given(self):
        """The options of the operator as the engine takes them."""
        return options.values(self.operation, self, self.without)

    def finish(self, context, made, request):
        """Takes in what the engine gives."""
        _new_object(context, made, request)
        for warning in made.warnings:
            self.report({"WARNING"}, warning)

    def _close(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()

    def _ended(self, context, job, request):
        if job.error is not None:
            problem = problems.told(job.error)
            if problem is not None and problem.at is not None:
                place = np.array(request.frame) @ [*problem.at, 1.0]
                context.scene.cursor.location = place[:3]
            return self._failed(problem) if problem is not None else {"CANCELLED"}
        if job.made is None:
            return {"CANCELLED"}
        self.finish(context, job.made, request)
        return {"FINISHED"}

    def _failed(self, problem):
        remedy = f". {problem.remedy}" if problem.remedy else ""
        self.report({"ERROR"}, f"{problem}{remedy}")
        return {"CANCELLED"}


def _selected(context):
    active = context.active_object
    chosen = [thing for thing in context.selected_objects if thing.type in KINDS]
    return sorted(chosen, key=lambda thing: thing != active)


def _new_object(context, made, request):
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    first = request.things[0]
    name = f"{first.name}.{request.function}"
    thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    context.collection.objects.link(thing)
    build.fill(thing, request.stack, made)
    thing.matrix_world = Matrix(request.frame.tolist())
    for other in context.selected_objects:
        other.select_set(False)
    thing.select_set(True)
    context.view_layer.objects.active = thing




def _add(cls, operation, without=(), **extra):
    annotations = {**extra, **options.annotations(operation, without=without)}
    cls.operation, cls.without, cls.extra = operation, without, tuple(extra)
    cls.__annotations__ = annotations
    cls.__doc__ = options.summary(operation)
    return cls


class FUSION_OT_remesh(_Operation, bpy.types.Operator):
    bl_idname = "fusion.remesh"
    bl_label = "Remesh"

    def request(self, context):
        return Request("remesh", _selected(context)[:1], self.given())


class FUSION_OT_sharpen(_Operation, bpy.types.Operator):
    bl_idname = "fusion.sharpen"
    bl_label = "Sharpen Fillet"

    def request(self, context):
        request = Request("sharpen", _selected(context)[:1], self.given())
        at_cursor = [gather.cursor(context, request.frame)[0]]
        request.options["near"] = gather.picked(request.things[0], request.frame) if self.picked else at_cursor
        if not request.options["near"]:
            raise problems.Problem("no vertex is selected", remedy="Select a vertex on each fillet, or use the 3D cursor")
        return request


class FUSION_OT_cut(_Operation, bpy.types.Operator):
    bl_idname = "fusion.cut"
    bl_label = "Cut"

    def request(self, context):
        request = Request("cut", _selected(context)[:1], self.given())
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


class FUSION_OT_cluster(_Operation, bpy.types.Operator):
    bl_idname = "fusion.cluster"
    bl_label = "Cluster Polyhedron"

    def request(self, context):
        return Request("cluster", _selected(context)[:1], self.given(), polygons=True)


class FUSION_OT_compose(_Operation, bpy.types.Operator):
    bl_idname = "fusion.compose"
    bl_label = "Compose Openings"
    least = 1

    def request(self, context):
        pens = [thing for thing in context.selected_objects if thing.type in gather.STROKES]
        parts = [thing for thing in _selected(context) if thing not in pens]
        if not parts:
            raise problems.Problem("no open mesh is selected", remedy="Select the meshes whose openings are to be joined")
        request = Request("compose", parts, self.given())
        found = gather.strokes(pens, request.frame)
        if found:
            seen = gather.view_direction(context)
            view = gather.turned(request.frame, self.view if seen is None or not self.from_view else seen)
            request.options["silhouette"] = [{"view": view, "stroke": stroke} for stroke in found]
        return request


class FUSION_OT_detail(_Operation, bpy.types.Operator):
    bl_idname = "fusion.detail"
    bl_label = "Transfer Detail"

    def request(self, context):
        things = _selected(context)[:2]
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


class FUSION_OT_max_radius(_Operation, bpy.types.Operator):
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
        things = _selected(context)
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
            from . import edges

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


_add(FUSION_OT_remesh, "remesh")
_add(
    FUSION_OT_sharpen,
    "sharpen",
    picked=bpy.props.BoolProperty(
        name="Selected Vertices", description="The fillets at the selected vertices; else that at the 3D cursor"
    ),
)
_add(
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
_add(FUSION_OT_cluster, "cluster")
_add(
    FUSION_OT_compose,
    "compose",
    from_view=bpy.props.BoolProperty(
        name="As Seen", description="Strokes are drawn as the 3D view looks", default=True
    ),
    view=bpy.props.FloatVectorProperty(
        name="View", description="Where the view of the strokes looks, if not the 3D view's", default=(0.0, 1.0, 0.0)
    ),
)
_add(
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
