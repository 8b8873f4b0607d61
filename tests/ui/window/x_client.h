#pragma once
// What other programs of a desktop do, on the display that DISPLAY names.

#include <string>

// Drops a file into the window of that title as a file manager does: the XDND protocol, from its sending end. False
// when it was not taken within 5 s.
bool dropFile(const std::string& windowTitle, const std::string& file);

// Says how fine the display is, as settings daemons do: 96 is a scale of 1.
void setDpi(int dotsPerInch);
