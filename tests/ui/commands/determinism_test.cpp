// The same bits whatever the number of the driver's threads (llvmpipe's own variable), for every method.

#include "tests/support/trichrome.h"

#include <cstdlib>

class Determinism : public Trichrome
{
};

TEST_F(Determinism, ThreadsOfTheDriverChangeNothing)
{
    for (const std::string method : {"pt", "rgb-restir"}) {
        std::vector<std::string> files;
        for (const std::string threads : {"1", "2", "7"}) {
            setenv("LP_NUM_THREADS", threads.c_str(), 1);
            files.push_back(directory / (method + threads + ".exr"));
            runWell({"render", "hall", "-o", files.back(), "--method", method, "--size", "48x27", "--frames", "3",
                     "--spatial", "1"});
            unsetenv("LP_NUM_THREADS");
        }
        EXPECT_EQ(readFile(files[0]), readFile(files[1])) << method;
        EXPECT_EQ(readFile(files[0]), readFile(files[2])) << method;
    }
}
