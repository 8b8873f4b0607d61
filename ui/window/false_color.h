#pragma once
// What the reservoirs of a picture hold, as colors.

#include <string>
#include <vector>

#include "ui/window/picture_view.h"

namespace ui
{

// Gray where the picture came without reservoirs.
ScreenPicture falseColors(const Shot& shot, FalseColor view, int reservoir);

// What the colors mean in this picture, word by word: "confidence: black 1, white 20 frames".
struct LegendWord {
    std::string text;
    glm::vec3 color = glm::vec3(1); // sRGB-encoded, 0 to 1
};
std::vector<LegendWord> legendOf(const Shot& shot, const Floor* floor, FalseColor view, int reservoir);

// How many reservoirs a pixel of the shot has; 0: it came without.
int reservoirCount(const Shot& shot);

} // namespace ui
