// Every member of the structs that C++ and shaders share: X(member). Read by both languages.
// clang-format off
#define FRAME_MEMBERS(X) \
    X(camera.position.x) X(camera.right.y) X(camera.up.z) X(camera.forward.w) \
    X(previousCamera.position.x) X(previousCamera.right.y) X(previousCamera.up.z) X(previousCamera.forward.w) \
    X(width) X(height) X(frame) X(key0) X(key1) X(slice) X(previousSlice) X(maxConfidence) X(neighborCount) X(neighborRadius) \
    X(target[0].x) X(target[3].w) X(resolve[0].y) X(resolve[3].z)
#define SCENE_MEMBERS(X) \
    X(attributeRows) X(materialOffset) X(lightOffset) X(lightCount) X(punctualOffset) X(environmentOffset) \
    X(environmentAliasOffset) X(environmentWidth) X(environmentHeight) X(environmentPick) X(radius)
// clang-format on
