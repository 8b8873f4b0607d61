#pragma once
// Checks of options that are numbers.

#include <string>
#include <type_traits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace ui
{

// What CLI::Range is for, but that lets "nan" pass, since no comparison with it holds. Finite limits leave out infinity
// too. CLI11 puts the option's name before the complaint.
template <class T>
CLI::Validator within(T low, T high)
{
    return CLI::Validator(
        [low, high](const std::string& text) -> std::string {
            T value{};
            if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return "";
            return fmt::format("\"{}\" is no {}number from {} to {}.", text, std::is_integral_v<T> ? "whole " : "", low,
                               high);
        },
        "");
}

} // namespace ui
