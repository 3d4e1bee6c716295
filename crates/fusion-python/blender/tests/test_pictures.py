"""Renders the pictures of docs/blender.md, and looks whether they show something.

They go to the folder FUSION_PICTURES, such as docs/images; without it to one that is thrown away.
"""

import os
import tempfile

import bpy
import numpy as np
from harness import boolean, cube, cylinder, run, select
from mathutils import Vector

SIZE = (480, 360)


def paint(thing, colors):
    """Materials of these colours on an object without any."""
    for name, color in colors.items():
        material = bpy.data.materials.new(name)
        material.diffuse_color = (*color, 1)
        thing.data.materials.append(material)


def stage(eye, at=(0, 0, 0), width=4.2):
    """A camera, and Workbench with the colours of materials."""
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("eye")
    camera.type, camera.ortho_scale = "ORTHO", width
    holder = bpy.data.objects.new("eye", camera)
    holder.location = eye
    holder.rotation_euler = (Vector(at) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(holder)
    scene.camera = holder
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.light = "STUDIO"
    scene.display.shading.color_type = "MATERIAL"
    scene.display.shading.show_cavity = True
    scene.display.render_aa = "8"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.film_transparent = False
    if scene.world is None:
        scene.world = bpy.data.worlds.new("world")
    scene.world.color = (1, 1, 1)


def wires(thing):
    """The edges of an object as thin dark bars, polygons as they are."""
    copy = thing.copy()
    copy.data = thing.data.copy()
    copy.fusion.kind = "NONE"
    copy.data.materials.clear()
    bpy.context.scene.collection.objects.link(copy)
    modifier = copy.modifiers.new("wires", "WIREFRAME")
    modifier.thickness, modifier.use_replace, modifier.use_even_offset = 0.006, True, False
    paint(copy, {"wire": (0.02, 0.02, 0.02)})
    return copy


def render(name):
    """Renders into the file of a picture; gives its colours."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(os.environ.get("FUSION_PICTURES", folder), f"{name}.png")
        bpy.context.scene.render.filepath = path
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(path)
        pixels = np.array(image.pixels[:]).reshape(SIZE[1], SIZE[0], 4)
        bpy.data.images.remove(image)
    return pixels


def share(pixels, chosen):
    """The share of the picture whose colour is chosen."""
    red, green, blue = (pixels[:, :, k] for k in range(3))
    return float(chosen(red, green, blue).mean())


def orange(red, green, blue):
    return (red > 1.5 * green) & (green > 1.5 * blue) & (red > 0.25)


def test_quads_away_from_the_seam():
    block, drill = cube(cuts=4), cylinder(vertices=32)
    paint(block, {"block": (0.35, 0.5, 0.7)})
    paint(drill, {"drill": (0.8, 0.8, 0.8)})
    fillet = bpy.data.materials.new("fillet")
    fillet.diffuse_color = (0.9, 0.35, 0.05, 1)
    result = boolean(block, drill, radius=0.15)
    result.fusion.material = fillet
    bpy.context.view_layer.update()
    block.hide_render = drill.hide_render = True
    wires(result)
    stage((3, -4, 4))
    pixels = render("blender-quads")
    assert 0.004 < share(pixels, orange) < 0.3


def test_a_fillet_follows_its_cutter():
    """Three places of one cutter in one picture: the result is copied before the cutter moves on."""
    block, drill = cube(cuts=3), cylinder(radius=0.45, vertices=48)
    paint(block, {"block": (0.35, 0.5, 0.7)})
    fillet = bpy.data.materials.new("fillet")
    fillet.diffuse_color = (0.9, 0.35, 0.05, 1)
    result = boolean(block, drill, radius=0.15)
    result.fusion.material = fillet
    for step, place in enumerate(((-0.3, -0.3), (0.35, 0.0), (1.0, -0.2))):
        drill.location.xy = place
        bpy.context.view_layer.update()
        assert not result.fusion.is_error, result.fusion.message
        copy = bpy.data.objects.new("copy", result.data.copy())
        copy.location.x = 2.8 * step
        bpy.context.scene.collection.objects.link(copy)
    for thing in (block, drill, result):
        thing.hide_render = True
    stage((2.8 + 2, -6, 5), at=(2.8, 0, 0), width=8.6)
    assert share(render("blender-live"), orange) > 0.01


def test_edges_of_a_part():
    block = cube()
    paint(block, {"block": (0.35, 0.5, 0.7)})
    fillet = bpy.data.materials.new("fillet")
    fillet.diffuse_color = (0.9, 0.35, 0.05, 1)
    post = cylinder(radius=0.5, vertices=48, at=(0, 0, 1))
    solid = boolean(block, post, operation="union", radius=0.0)
    select(solid)
    assert bpy.ops.fusion.add_blend(radius=0.2) == {"FINISHED"}
    result = bpy.context.object
    result.fusion.material = fillet
    bpy.context.view_layer.update()
    for thing in (block, post, solid):
        thing.hide_render = True
    stage((3, -4, 4), at=(0, 0, 0.5), width=5)
    assert share(render("blender-edges"), orange) > 0.05


run(globals())
