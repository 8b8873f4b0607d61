#pragma once
// The sidebar: every setting, what it does to the picture, and what the picture cost.

#include <array>
#include <map>
#include <memory>
#include <string>

#include "ui/window/render_thread.h"
#include "ui/window/tone.h"

namespace ui
{

constexpr float PANEL_WIDTH = 400; // at a content scale of 1

struct PanelState {
    Order order;
    Tone tone;
    bool help = false, screenshot = false, resetView = false;
    std::string message;                              // the last thing that the person should know
    std::map<std::string, std::array<int, 2>> places; // middle of the widgets, for scripts that click
};

void drawPanel(PanelState& state, const std::shared_ptr<const Shot>& shot, const std::string& activity, float scale);

void drawHelp(bool& open);

} // namespace ui
