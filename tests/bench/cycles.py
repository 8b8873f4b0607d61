"""Renders a glTF of rivals.py by Blender's Cycles: blender -b --factory-startup -noaudio -P cycles.py -- GLTF EXR SIZE BOUNCES SAMPLES...

The materials are replaced by exact Lambert or emission. For each number of samples a line of JSON: seconds, and the picture's mean.
"""

import json
import sys
import time

import bpy
import numpy

file, picture, size, bounces = sys.argv[sys.argv.index("--") + 1:][:4]
samples = [int(n) for n in sys.argv[sys.argv.index("--") + 5:]]

for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.ops.import_scene.gltf(filepath=file, import_shading="FLAT")
for described in json.load(open(file))["materials"]:
    material = bpy.data.materials[described["name"]]
    nodes = material.node_tree.nodes
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if "emissiveFactor" in described:
        shader = nodes.new("ShaderNodeEmission")
        color = described["emissiveFactor"]
        shader.inputs["Strength"].default_value = described["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
    else:
        shader = nodes.new("ShaderNodeBsdfDiffuse")
        color = described["pbrMetallicRoughness"]["baseColorFactor"]
    shader.inputs["Color"].default_value = (*color[:3], 1)
    material.node_tree.links.new(shader.outputs[0], output.inputs["Surface"])

scene = bpy.context.scene
scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
scene.world = bpy.data.worlds.new("black")
scene.world.color = (0, 0, 0)
render, cycles = scene.render, scene.cycles
render.engine = "CYCLES"
render.resolution_x = render.resolution_y = int(size)
render.resolution_percentage = 100
render.filepath = picture
render.image_settings.file_format = "OPEN_EXR"
render.image_settings.color_depth = "32"
render.use_persistent_data = True
cycles.device = "CPU"
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.max_bounces = cycles.diffuse_bounces = int(bounces) - 1  # Cycles does not count direct light
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
cycles.pixel_filter_type = "BOX"
cycles.filter_width = 1
for n in [1] + samples:  # the first, which builds the scene, does not count
    cycles.samples = n
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    seconds = time.monotonic() - start
    image = bpy.data.images.load(picture)
    pixels = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    print("JSON", json.dumps({"samples": n, "seconds": seconds, "mean": [float(x) for x in pixels.reshape(-1, 4)[:, :3].mean(0, dtype="f8")]}), flush=True)
