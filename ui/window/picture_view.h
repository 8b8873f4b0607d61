#pragma once
// Which picture is on the screen: one of the sides or the reference, two of them split by a line, their difference, or
// what the reservoirs hold in false colors.

#include <memory>
#include <string>

#include "ui/window/findings.h"
#include "ui/window/tone.h"

namespace ui
{

enum class Source : int { A, B, Reference };
enum class Layout : int { One, Split, Difference };
enum class FalseColor : int {
    Off,
    Confidence,
    Weight,
    Agreement,
    Length,
    FailedShifts,
    ShiftOutcomes,
    Floor,
    NotFinite
};
constexpr int FALSE_COLORS = int(FalseColor::NotFinite) + 1;

struct View {
    Source first = Source::A, second = Source::B;
    Layout layout = Layout::One;
    bool flipped = false; // first and second change places
    float wipe = 0.5f;    // where the split is, from the left
    FalseColor falseColor = FalseColor::Off;
    int reservoir = 0; // whose weight, length and shifts
    bool operator==(const View&) const = default;

    Source left() const { return flipped ? second : first; }
    Source right() const { return flipped ? first : second; }
};

struct Pictures {
    ShotPointer sides[SIDES];
    ReferencePointer reference;
    std::shared_ptr<const Floor> floors[SIDES];
    bool operator==(const Pictures&) const = default;

    const image::Image* of(Source source) const; // null: there is none
    ShotPointer shotOf(Source source) const;     // null: none, or a reference
    const Floor* floorOf(Source source) const;   // null: none yet
};

// Empty (0 x 0) while there is no picture. Where one of two is missing, the other stands alone.
ScreenPicture compose(const Pictures& pictures, const View& view);

} // namespace ui
