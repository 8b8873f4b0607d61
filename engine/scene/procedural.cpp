#include "engine/scene/procedural.h"

#include "engine/scene/shapes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace scene
{

std::vector<BuiltInScene> builtInScenes()
{
    return {
        {"hall", "A columned hall with curtains under saturated spotlights: coloured indirect light.", makeHall},
        {"cornell", "The Cornell box: one area light, two coloured walls, all Lambert.", makeCornell},
        {"lamps", "A terrace at night under hundreds of small coloured lamps: coloured direct light.", makeLamps},
        {"dim", "A room lit through its doorway by a white lamp around the corner: indirect light.", makeDim},
        {"carousel", "A carousel that turns in a hall under colored lamps: bodies that keep their shape move.",
         makeCarousel},
        {"flags", "Flags that wave between colored lamps: bodies that change their shape move.", makeFlags},
        {"furnace", "The inside of a glowing sphere whose radiance is known: 1 - albedo^(bounces + 1).", makeFurnace},
    };
}

Scene makeCornell()
{
    Scene scene;
    scene.name = "cornell";
    const uint32_t white = addMaterial(scene, diffuse("white", {0.73f, 0.73f, 0.73f}));
    const uint32_t red = addMaterial(scene, diffuse("red", {0.63f, 0.065f, 0.05f}));
    const uint32_t green = addMaterial(scene, diffuse("green", {0.14f, 0.45f, 0.091f}));
    const uint32_t lamp = addMaterial(scene, emitter("lamp", {18, 14, 9}));

    const float w = 0.5528f, h = 0.5488f, d = 0.5592f; // meters; the camera looks along +z, so +x is left
    const glm::vec3 x(w, 0, 0), y(0, h, 0), z(0, 0, d);
    addQuad(scene, white, {0, 0, 0}, z, x); // floor
    addQuad(scene, white, y, x, z);         // ceiling
    addQuad(scene, white, z, y, x);         // back
    addQuad(scene, red, x, y, z);           // left
    addQuad(scene, green, {0, 0, 0}, z, y); // right
    addQuad(scene, lamp, {0.213f, h - 0.0005f, 0.227f}, {0.13f, 0, 0}, {0, 0, 0.105f});

    const auto addBlock = [&](glm::vec2 center, float height, float degrees) {
        glm::mat4 transform = glm::translate(glm::mat4(1), {center.x, height / 2, center.y});
        transform = glm::rotate(transform, glm::radians(degrees), {0, 1, 0});
        addBox(scene, white, glm::scale(transform, {0.083f, height / 2, 0.083f}));
    };
    addBlock({0.1855f, 0.169f}, 0.165f, -17.0f);
    addBlock({0.3685f, 0.3515f}, 0.33f, 17.2f);

    scene.cameras.push_back(lookAt("front", {0.2764, 0.2744, -0.79}, {0.2764, 0.2744, 0.28}, 39.0));
    return scene;
}

Scene makeFurnace()
{
    Scene scene;
    scene.name = "furnace";
    Material wall = diffuse("wall", FURNACE_ALBEDO);
    wall.emission = 1.0f - FURNACE_ALBEDO;
    addSphere(scene, addMaterial(scene, wall), {0, 0, 0}, 1, 3, Normals::Flat, Facing::Inward);
    scene.cameras.push_back(lookAt("inside", {0.2, 0.1, 0.3}, {-0.4, -0.2, -0.5}, 60.0));
    return scene;
}

} // namespace scene
