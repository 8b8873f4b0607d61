#pragma once
// What the window shows, for scripts: `view --report`.

#include <nlohmann/json_fwd.hpp>

#include "ui/window/error_meter.h"
#include "ui/window/window_state.h"

namespace ui
{

nlohmann::ordered_json reportOf(const WindowState& state, const ErrorMeter& meter);

} // namespace ui
