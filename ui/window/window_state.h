#pragma once
// What the rooms of the panel show and change, and what they ask the window to do.

#include <optional>
#include <string>
#include <vector>

#include "ui/window/error_meter.h"
#include "ui/window/false_color.h"
#include "ui/window/order.h"
#include "ui/window/picture_view.h"
#include "ui/window/tone.h"
#include "ui/window/widgets.h"

namespace ui
{

// Done by the window after the widgets, once.
struct Requests {
    bool screenshot = false, resetView = false, freeze = false, converge = false, dropReference = false;
    bool undo = false, redo = false, film = false, savePath = false;
    std::string file; // to open, as if it had been dropped into the window
    std::string preset;
};

// A key that went down since the last time, with what was held then: GLFW's numbers.
struct KeyPress {
    int key = 0, modifiers = 0;
};

struct WindowState {
    std::vector<KeyPress> keys;
    Order order;
    Side editing = A; // whose settings the panel shows
    Tone tone;
    View view;
    bool help = false, plots = false, correlation = false, pixel = false, hidden = false;
    double start = 0;    // seconds, of the scene in frame 0 of the timeline
    std::string message; // the last thing that the person should know
    std::vector<std::string> recent;
    bool canUndo = false, canRedo = false;
    Requests requests;
    Places places;

    // What there is to show this time.
    std::shared_ptr<const SceneFacts> facts; // of the last scene that was loaded; null: none yet
    bool sceneIsThere() const { return facts && facts->name == order.scene.name; }
    Pictures pictures;
    std::shared_ptr<const Findings> findings = std::make_shared<const Findings>(); // never null
    std::vector<LegendWord> legend;         // of the false colors of the picture on the left
    std::array<int, 4> area = {0, 0, 0, 0}; // of the picture on the screen: left, top, width, height
    std::string activity, ahead;
    std::optional<std::array<uint32_t, 2>> inspected; // pixel that the mouse was over last
    float scale = 1;                                  // of the display
    float panelWidth() const { return hidden ? 0 : 400 * scale; }

    passes::Settings& edited() { return editing == B && order.rival ? *order.rival : order.settings; }
};

// A second side, or none again. B begins as a copy of A with another method.
void compare(WindowState& state, bool on);

} // namespace ui
