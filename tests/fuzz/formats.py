"""What is fuzzed."""

IMAGES = ("png", "hdr", "exr", "jpg")
TARGETS = ("scene", "obj", "mtl", "ply", "stl", "gltf", "glb", *IMAGES)
