"""What all operators share that run one operation and put its result into a new object."""

import bpy
import numpy as np
from mathutils import Matrix

from . import build, options, problems, snapshot
from .engine import Job
from .stack import stack
from .surface import KINDS

_INTERVAL = 0.05


class Request:
    """Which function of the engine on which objects."""

    def __init__(self, function, things, given=None, polygons=False):
        # A script may have changed something since Blender last looked.
        bpy.context.view_layer.update()
        self.things = things
        self.surfaces = [s for s, _ in snapshot.surfaces_of(things)]
        self.frame, matrices = snapshot.frame_of(things)
        self.stack = stack(self.surfaces, matrices)
        self.function, self.options, self.polygons = function, dict(given or {}), polygons

    def start(self):
        """The job in its thread."""
        return Job(self.function, self.stack, self.options, self.polygons)


class Operation:
    """Runs in a thread: at once in a script, and with the mouse free, progress shown and Esc to stop in the window."""

    bl_options = {"REGISTER", "UNDO"}
    least = 1

    @classmethod
    def poll(cls, context):
        return context.mode in {"OBJECT", "EDIT_MESH"} and len(selected(context)) >= cls.least

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


def selected(context):
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


def offer(cls, operation, without=(), **extra):
    """Gives a class the options of its operation, and properties of its own before them."""
    annotations = {**extra, **options.annotations(operation, without=without)}
    cls.operation, cls.without, cls.extra = operation, without, tuple(extra)
    cls.__annotations__ = annotations
    cls.__doc__ = options.summary(operation)
    return cls
