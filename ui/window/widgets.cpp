#include "ui/window/widgets.h"

#include <algorithm>
#include <cinttypes>

#include <imgui_stdlib.h>

namespace ui
{

void remember(Places& places, const std::string& name)
{
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places[name] = {int(low.x + high.x) / 2, int(low.y + high.y) / 2};
}

void explain(const char* text)
{
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool choose(Places& places, const std::string& name, int& value, const std::vector<const char*>& labels,
            const char* doc)
{
    const int before = value;
    int i = 0;
    for (const char* label : labels) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(fmt::format("{}##{}", label, name).c_str(), value == i)) value = i;
        remember(places, fmt::format("{}.{}", name, i));
        explain(doc);
        ++i;
    }
    return value != before;
}

bool button(Places& places, const char* label, const std::string& name, const char* doc)
{
    const bool pressed = ImGui::Button(fmt::format("{}##{}", label, name).c_str());
    remember(places, name);
    explain(doc);
    return pressed;
}

bool checkbox(Places& places, const char* label, const std::string& name, bool& value, const char* doc)
{
    const bool changed = ImGui::Checkbox(label, &value);
    remember(places, name);
    explain(doc);
    return changed;
}

void sentence(const ImVec4& color, const std::string& text)
{
    ImGui::PushTextWrapPos();
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

namespace
{

// Enumerations have a button for each value.
template <class T>
requires std::is_enum_v<T>
void edit(Places& places, const passes::Knob& knob, T& value)
{
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(colors::GRAY, "%s", knob.name);
    explain(knob.doc);
    ImGui::SameLine(std::max(4.2f * ImGui::GetFontSize(), ImGui::CalcTextSize(knob.name).x + ImGui::GetFontSize()));
    choose(places, knob.name, value, {passes::LABELS_OF<T>.begin(), passes::LABELS_OF<T>.end()}, knob.doc);
}

// Everything else is one widget.
void show(const passes::Knob& knob, bool& value)
{
    ImGui::Checkbox(knob.name, &value);
}
void show(const passes::Knob& knob, uint32_t& value)
{
    const uint32_t low = uint32_t(knob.low), high = uint32_t(knob.high);
    const auto flags = ImGuiSliderFlags_AlwaysClamp | (high > 1000 ? ImGuiSliderFlags_Logarithmic : 0);
    ImGui::SliderScalar(knob.name, ImGuiDataType_U32, &value, &low, &high, "%u", flags);
}
void show(const passes::Knob& knob, float& value)
{
    ImGui::SliderFloat(knob.name, &value, float(knob.low), float(knob.high), "%.3g",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
}
void show(const passes::Knob& knob, double& value)
{
    double typed = value;
    if (ImGui::InputDouble(knob.name, &typed) && typed >= knob.low && typed <= knob.high) value = typed;
}
void show(const passes::Knob& knob, uint64_t& value)
{
    ImGui::InputScalar(knob.name, ImGuiDataType_U64, &value, nullptr, nullptr, "%" PRIu64,
                       ImGuiInputTextFlags_EnterReturnsTrue);
}
void show(const passes::Knob& knob, std::string& value)
{
    std::string text = value;
    if (ImGui::InputText(knob.name, &text, ImGuiInputTextFlags_EnterReturnsTrue)) value = text;
}
void show(const passes::Knob& knob, passes::SizeField<uint32_t>&& size)
{
    int values[2] = {int(size.width), int(size.height)};
    if (!ImGui::InputInt2(knob.name, values, ImGuiInputTextFlags_EnterReturnsTrue)) return;
    size.width = uint32_t(std::clamp(values[0], 1, 8192));
    size.height = uint32_t(std::clamp(values[1], 1, 8192));
}
template <class T>
void edit(Places& places, const passes::Knob& knob, T&& value)
{
    show(knob, std::forward<T>(value));
    remember(places, knob.name);
    explain(knob.doc);
}

} // namespace

void editSettings(Places& places, passes::Settings& settings, const std::function<bool(const passes::Knob&)>& wanted)
{
    passes::visitSettings(settings, [&]<class T>(const passes::Knob& knob, T&& field) {
        if (wanted(knob)) edit(places, knob, std::forward<T>(field));
    });
}

} // namespace ui
