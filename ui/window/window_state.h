#pragma once
// What the rooms of the panel show and change, and what they ask the window to do.

#include <optional>
#include <string>
#include <vector>

#include "ui/window/error_meter.h"
#include "ui/window/order.h"
#include "ui/window/picture_view.h"
#include "ui/window/tone.h"
#include "ui/window/widgets.h"

namespace ui
{

// Done by the window after the widgets, once.
struct Requests {
    bool screenshot = false, resetView = false, freeze = false, dropReference = false, undo = false, redo = false;
    std::string file; // to open, as if it had been dropped into the window
    std::string preset;
};

struct WindowState {
    Order order;
    Side editing = A; // whose settings the panel shows
    Tone tone;
    View view;
    bool help = false, plots = false, pixel = false, hidden = false;
    std::string message; // the last thing that the person should know
    std::vector<std::string> recent;
    bool canUndo = false, canRedo = false;
    Requests requests;
    Places places;

    // What there is to show this time.
    Pictures pictures;
    std::string activity, ahead;
    std::optional<std::array<uint32_t, 2>> hovered; // pixel under the mouse
    float scale = 1;                                // of the display
    float panelWidth() const { return hidden ? 0 : 400 * scale; }

    passes::Settings& edited() { return editing == B && order.rival ? *order.rival : order.settings; }
};

// A second side, or none again. B begins as a copy of A with another method.
void compare(WindowState& state, bool on);

} // namespace ui
