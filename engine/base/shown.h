#pragma once
// Texts of strangers inside our sentences: shortened, control characters replaced.

#include <cstddef>
#include <string>

std::string shown(const std::string& text, size_t maxLength = 60);
