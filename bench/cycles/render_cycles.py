"""Run by Blender: blender -b --python render_cycles.py -- SCENE.gltf OUT.exr WIDTH SAMPLES SEED THREADS
Plain Cycles on the CPU: box filter, no clamp, no denoiser, no adaptive sampling, unbounded-like depth."""
import sys

import numpy

numpy.bool = bool  # the importer of Blender 3.4 uses the old name
import bpy

scene_file, out, width, samples, seed, threads = sys.argv[sys.argv.index("--") + 1:][:6]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
bpy.ops.preferences.addon_enable(module="cycles")
bpy.ops.import_scene.gltf(filepath=scene_file)
scene = bpy.context.scene
scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
for material in bpy.data.materials:
    # Exactly diffuse: glTF's specular term is switched off in both renderers.
    tree = material.node_tree
    principled = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
    if principled is None:
        continue
    color = principled.inputs["Base Color"].default_value[:]
    emission = principled.inputs["Emission"].default_value[:]
    strength = principled.inputs["Emission Strength"].default_value
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    if max(emission[:3]) * strength > 0:
        shader = tree.nodes.new("ShaderNodeEmission")
        shader.inputs["Color"].default_value = emission
        shader.inputs["Strength"].default_value = strength
    else:
        shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
        shader.inputs["Color"].default_value = color
        shader.inputs["Roughness"].default_value = 0
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
scene.render.engine = "CYCLES"
cycles = scene.cycles
cycles.device = "CPU"
cycles.samples = int(samples)
cycles.seed = int(seed)
cycles.use_adaptive_sampling = False
cycles.use_denoising = False
cycles.sample_clamp_direct = 0
cycles.sample_clamp_indirect = 0
cycles.blur_glossy = 0
cycles.light_sampling_threshold = 0
cycles.max_bounces = 1024
cycles.diffuse_bounces = 1024
cycles.glossy_bounces = 1024
cycles.pixel_filter_type = "BOX"
cycles.filter_width = 1.0
scene.render.threads_mode = "FIXED"
scene.render.threads = int(threads)
scene.render.resolution_x = scene.render.resolution_y = int(width)
scene.render.resolution_percentage = 100
scene.render.use_persistent_data = False
scene.view_settings.view_transform = "Raw"
scene.world = None
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.filepath = out
bpy.ops.render.render(write_still=True)
