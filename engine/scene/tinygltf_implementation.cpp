// The one translation unit that compiles tinygltf.

#include <fstream> // its writer, which we do not use, needs it even without file access

#define TINYGLTF_IMPLEMENTATION
#include "engine/scene/tinygltf.h"
