#pragma once
// The window: what hands do becomes an order to the render thread, what the thread finishes becomes a picture.

#include <string>

#include "ui/cli/device_options.h"
#include "ui/window/order.h"

namespace ui
{

struct WindowOptions {
    DeviceOptions device;
    Order order;           // to begin with
    std::string reference; // picture to measure errors against; empty: none
    std::string report;    // file that always says what the window shows, for scripts; empty: none
};

// Until the window is closed, or SIGTERM or SIGINT comes. Throws Error: no window can be shown.
void showWindow(const WindowOptions& options);

} // namespace ui
