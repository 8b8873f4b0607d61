#include "ui/window/pixel_room.h"

#include "ui/window/false_color.h"

#include "passes/estimator.h"

#include <algorithm>

namespace ui
{

namespace
{

std::string targetName(const glm::vec3& target)
{
    std::string name;
    for (int c = 0; c < 3; ++c)
        if (target[c] > 0) name += "RGB"[c];
    return name == "RGB" ? "luminance" : name;
}

void drawReservoirs(const Shot& shot, uint32_t x, uint32_t y)
{
    const int count = reservoirCount(shot);
    if (count == 0) {
        ImGui::TextColored(colors::GRAY, "no reservoirs: %s",
                           shot.order.settings.method == passes::Method::Pt ? "the path tracer has none"
                                                                            : "not read yet");
        return;
    }
    const passes::Estimator& estimator = passes::estimatorOf(shot.order.settings.method);
    const size_t pixels = shot.picture.pixels.size(), pixel = size_t{y} * shot.picture.width + x;
    ImGui::Text("confidence %u frames", shot.reservoirs[pixel].confidence);
    if (!ImGui::BeginTable("reservoirs", 7, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
    for (const char* title :
         {"target", "sample: frame/pixel/leaf", "bounces", "p_hat", "weight sum", "W", "shifts failed"}) {
        ImGui::TableNextColumn();
        ImGui::TextColored(colors::GRAY, "%s", title);
    }
    for (int c = 0; c < count; ++c) {
        const shared::Inspection& seen = shot.reservoirs[size_t(c) * pixels + pixel];
        const uint32_t leaf = seen.leafAndJoint & 0xffff, joint = seen.leafAndJoint >> 16;
        const bool holds = seen.weightSum > 0;
        const auto cell = [](const std::string& text) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(text.c_str());
        };
        cell(targetName(estimator.target[size_t(c)]));
        cell(holds ? fmt::format("{}/{}/{}", seen.seedFrame, seen.seedPixel, leaf) : "none");
        cell(holds ? fmt::format("{}{}", seen.lengthAndShifts & 0xffff,
                                 joint > 0 ? fmt::format(", joins x{}", joint) : "")
                   : "");
        cell(fmt::format("{:.4g}", seen.target));
        cell(fmt::format("{:.4g}", seen.weightSum));
        cell(fmt::format("{:.4g}", seen.weight));
        cell(fmt::format("{} of {}", seen.lengthAndShifts >> 24, seen.lengthAndShifts >> 16 & 0xff));
    }
    ImGui::EndTable();
}

} // namespace

bool wantsReservoirs(const WindowState& state)
{
    return state.pixel || state.view.falseColor != FalseColor::Off;
}

void drawFalseColorRoom(WindowState& state)
{
    int view = int(state.view.falseColor);
    if (ImGui::Combo(
            "false colors", &view,
            "off\0confidence\0weight W\0which reservoirs agree\0path length\0failed spatial shifts\0not finite\0"))
        state.view.falseColor = FalseColor(view);
    remember(state.places, "false-colors");
    explain("What the reservoirs hold, read back with every picture (slower). X goes through them.");
    const ShotPointer shot = state.pictures.shotOf(state.view.left());
    const int count = shot ? reservoirCount(*shot) : 0;
    if (view != 0 && count > 1) {
        ImGui::SliderInt("of reservoir", &state.view.reservoir, 0, count - 1);
        state.view.reservoir = std::clamp(state.view.reservoir, 0, count - 1);
    }
    ImGui::Checkbox("inspect the pixel under the mouse (I)", &state.pixel);
    remember(state.places, "pixel");
    explain("Its color and what its reservoirs hold: sample, target p_hat, weight sum, weight W, confidence.");
}

void drawPixel(WindowState& state)
{
    if (!state.pixel) return;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({state.panelWidth() + 10, screen.y - 200 * state.scale}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints({200, 0}, {screen.x, screen.y});
    if (ImGui::Begin("Pixel", &state.pixel, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing)) {
        if (!state.hovered) {
            ImGui::TextColored(colors::GRAY, "Move the mouse over the picture.");
        } else {
            for (const Source source : {Source::A, Source::B, Source::Reference}) {
                const image::Image* picture = state.pictures.of(source);
                if (!picture) continue;
                // The mouse is told in pixels of the full size; pictures of a moving camera have fewer.
                const passes::Settings& full = state.order.settings;
                const uint32_t x = std::min((*state.hovered)[0] * picture->width / full.width, picture->width - 1);
                const uint32_t y = std::min((*state.hovered)[1] * picture->height / full.height, picture->height - 1);
                const glm::vec3& color = picture->at(x, y);
                ImGui::TextUnformatted(fmt::format("{}  pixel {}, {}:  {:.5g} {:.5g} {:.5g}",
                                                   source == Source::A   ? "A"
                                                   : source == Source::B ? "B"
                                                                         : "reference",
                                                   x, y, color.r, color.g, color.b)
                                           .c_str());
                if (const ShotPointer shot = state.pictures.shotOf(source)) {
                    ImGui::PushID(int(source));
                    drawReservoirs(*shot, x, y);
                    ImGui::PopID();
                }
            }
        }
    }
    ImGui::End();
}

} // namespace ui
