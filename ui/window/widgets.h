#pragma once
// What the rooms of the panel are built of: one editor per kind of setting, words that explain, tables.

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

#include "passes/settings.h"

namespace ui
{

namespace colors
{
const ImVec4 GREEN = {0.45f, 0.85f, 0.5f, 1}, AMBER = {1.0f, 0.75f, 0.3f, 1}, GRAY = {0.65f, 0.65f, 0.68f, 1};
const ImVec4 SIDES[2] = {{1.0f, 0.62f, 0.26f, 1}, {0.40f, 0.72f, 1.0f, 1}}; // of A and B, everywhere
} // namespace colors

// Middle of the widgets by name, in points, for scripts that click.
using Places = std::map<std::string, std::array<int, 2>>;

void remember(Places& places, const std::string& name); // the last widget
void explain(const char* text);                         // the last widget, while the mouse is over it

// One of several words; true when it changed.
bool choose(Places& places, const std::string& name, int& value, const std::vector<const char*>& labels,
            const char* doc);
template <class Choice>
bool choose(Places& places, const std::string& name, Choice& value, const std::vector<const char*>& labels,
            const char* doc)
{
    int index = int(value);
    const bool changed = choose(places, name, index, labels, doc);
    value = Choice(index);
    return changed;
}
bool checkbox(Places& places, const char* label, const std::string& name, bool& value, const char* doc);
bool button(Places& places, const char* label, const std::string& name, const char* doc);

// The settings for which `wanted(name)` holds, in the list's order.
void editSettings(Places& places, passes::Settings& settings, const std::function<bool(const passes::Knob&)>& wanted);

// A sentence as long as it likes.
void sentence(const ImVec4& color, const std::string& text);

// Names and values, folded away until opened.
template <class Value>
void drawTable(const char* title, const std::map<std::string, Value>& rows, const char* format)
{
    if (!ImGui::TreeNode(title)) return;
    for (const auto& [name, value] : rows) {
        ImGui::TextColored(colors::GRAY, "%s", name.c_str());
        ImGui::SameLine(ImGui::GetFontSize() * 19);
        ImGui::TextUnformatted(fmt::format(fmt::runtime(format), value).c_str());
    }
    ImGui::TreePop();
}

} // namespace ui
