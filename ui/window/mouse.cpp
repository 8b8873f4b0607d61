#include "ui/window/mouse.h"

#include <algorithm>

namespace ui
{

void Mouse::turned(int button, bool down)
{
    if (button >= 0 && button < ImGuiMouseButton_COUNT) events_.push_back({button, down, at_});
}

void Mouse::play(ImGuiIO& io)
{
    if (!events_.empty()) {
        const Event& event = events_.front();
        down_[size_t(event.button)] = event.down;
        io.MousePos = event.at;
        events_.pop_front();
    }
    std::ranges::copy(down_, io.MouseDown);
}

} // namespace ui
