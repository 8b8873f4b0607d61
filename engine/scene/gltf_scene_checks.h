#pragma once
// The parts of gltf_json_checks.h that hold no buffer data: materials, cameras, lights, nodes and scenes.

#include "engine/scene/gltf_json.h"

namespace scene::gltf
{

void checkCamerasAndLights(const Object& document);
void checkNodes(const Object& document); // with scenes; linear in the number of nodes

} // namespace scene::gltf
