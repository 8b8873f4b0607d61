#include "passes/experiments/correlation_store.h"

#include <gtest/gtest.h>

#include "tests/passes/experiments/exact_correlation.h"

TEST(CorrelationStore, GivesBatchesBackExactly)
{
    for (const passes::CorrelationBatch& batch : support::exact(3))
        EXPECT_EQ(passes::fromBytes(passes::toBytes(batch)), batch);
    EXPECT_ANY_THROW(passes::fromBytes(std::vector<std::byte>(10)));
}
