#pragma once
// Drops a file into a window as a file manager does: the XDND protocol, from its sending end.

#include <string>

// Into the window of that title on the display that DISPLAY names; false when it did not take the file within 5 s.
bool dropFile(const std::string& windowTitle, const std::string& file);
