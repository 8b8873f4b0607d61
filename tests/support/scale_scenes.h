#pragma once
// Scenes of several scales at once: what is near is small beside the whole, and must look as if it were alone.

#include "engine/scene/scene.h"

namespace support
{

scene::Scene farTriangle(); // a ball on a floor of 4 m, and a triangle 40 km away
scene::Scene dome();        // a pane of glass of 5 mm, and a sheet 2 mm above the floor, under a dome of 10 km
scene::Scene wideGround();  // a pane of 1 mm and a ball on a ground of 40 km

} // namespace support
