#include "ui/window/window_memory.h"

#include "tests/support/program.h"
#include "ui/window/undo_list.h"

#include <gtest/gtest.h>

TEST(WindowMemory, RecallsWhatItKeptAndTakesNothingElse)
{
    const TemporaryDirectory directory;
    const std::string file = directory / "deep/er/window.json";
    EXPECT_EQ(ui::recall(file), ui::WindowMemory{});
    ui::WindowMemory memory{.size = {900, 700}, .layout = "[Window][Pixel]\nPos=1,2\n"};
    for (const char* scene : {"hall", "cornell", "hall"}) memory.opened(scene);
    EXPECT_EQ(memory.recent, (std::vector<std::string>{"hall", "cornell"}));
    memory.bookmarks["hall"][8] = ui::Pose{.position = {0.1, 2, 3}, .yfov = 33};
    ui::keep(memory, file);
    EXPECT_EQ(ui::recall(file), memory);
    writeFile(file, "{\"size\": [1, 2]");
    EXPECT_EQ(ui::recall(file), ui::WindowMemory{});
}

TEST(UndoList, GoesBackAndForthOverSettledStates)
{
    ui::UndoList<int> list(0);
    EXPECT_FALSE(list.undo());
    list.watch(1, false); // a slider on its way
    list.watch(2, true);
    list.watch(3, true);
    EXPECT_EQ(list.undo(), 2);
    EXPECT_EQ(list.undo(), 0);
    EXPECT_FALSE(list.canUndo());
    EXPECT_EQ(list.redo(), 2);
    list.watch(7, true); // a new way: the old future is gone
    EXPECT_FALSE(list.canRedo());
    EXPECT_EQ(list.undo(), 2);
}
