#pragma once
// Refuses a glTF document that breaks the structure the rest of the loader relies on.

#include "engine/scene/gltf_json.h"

namespace scene::gltf
{

// Afterwards, but for materials, textures and samplers, which readMaterials() checks as far as it reads them: members
// have their types, indices are in range, every accessor and buffer view lies inside the declared
// length of its buffer, attributes of a primitive have equal counts and usable types, the nodes form a forest, and
// every required extension is supported. Throws Error.
void checkJson(const Json& document);

size_t lightCount(const Object& document); // of KHR_lights_punctual

bool isSupportedExtension(const std::string& name);

// Bytes of one element, with the padding of small matrix columns.
uint32_t componentSize(uint64_t componentType);
uint32_t componentCount(const std::string& type); // 0: unknown
uint32_t elementSize(uint64_t componentType, const std::string& type);

} // namespace scene::gltf
