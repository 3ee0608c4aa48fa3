#include "planner_ara/state_heap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

namespace planbench {
namespace {

using Rank = std::tuple<double, float, std::int64_t>;

Rank RankOf(const StateHeap::Entry& entry) {
  return {entry.key, entry.tie, -static_cast<std::int64_t>(entry.state)};
}

TEST(StateHeap, AgreesWithASortedMapUnderRandomUse) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    StateHeap heap;
    std::map<StateId, StateHeap::Entry> model;
    const auto first = [&] {
      return std::min_element(model.begin(), model.end(), [](const auto& a, const auto& b) {
        return RankOf(a.second) < RankOf(b.second);
      });
    };
    for (int step = 0; step < 3000; ++step) {
      if (random() % 3 != 0 || model.empty()) {
        // Few values, so that keys and ties meet; states above the size of a chunk too.
        const StateId state = random() % 200 * 50;
        const StateHeap::Entry entry{static_cast<double>(random() % 20),
                                     static_cast<float>(random() % 3), state};
        heap.Set(state, entry.key, entry.tie);
        model[state] = entry;
      } else {
        ASSERT_EQ(RankOf(heap.top()), RankOf(first()->second));
        const StateId state = heap.Pop();
        ASSERT_EQ(state, first()->first);
        model.erase(state);
        ASSERT_FALSE(heap.Contains(state));
      }
      ASSERT_EQ(heap.size(), model.size());
    }
    while (!model.empty()) {
      ASSERT_EQ(heap.Pop(), first()->first);
      model.erase(first());
    }
    EXPECT_TRUE(heap.empty());
  }
}

TEST(StateHeap, AssignReplacesTheContent) {
  std::mt19937 random(1);
  StateHeap heap;
  for (StateId state = 0; state < 100; ++state) heap.Set(state, 1, 0);
  std::vector<StateHeap::Entry> entries;
  for (StateId state = 50; state < 500; ++state) {
    entries.push_back({static_cast<double>(random() % 40), 0, state});
  }
  heap.Assign(entries);
  EXPECT_FALSE(heap.Contains(10));
  std::sort(entries.begin(), entries.end(),
            [](const auto& a, const auto& b) { return RankOf(a) < RankOf(b); });
  for (const StateHeap::Entry& entry : entries) ASSERT_EQ(heap.Pop(), entry.state);
  EXPECT_TRUE(heap.empty());
}

TEST(StateHeap, KeysCanRiseAndFall) {
  StateHeap heap;
  heap.Set(1, 1, 0);
  heap.Set(2, 2, 0);
  heap.Set(3, 3, 0);
  heap.Set(1, 4, 0);
  heap.Set(3, 0, 0);
  EXPECT_EQ(heap.size(), 3U);
  EXPECT_EQ(heap.Pop(), 3U);
  EXPECT_EQ(heap.Pop(), 2U);
  EXPECT_EQ(heap.Pop(), 1U);
}

TEST(StateHeap, OrderDoesNotDependOnHistory) {
  StateHeap heap;
  StateHeap other;
  for (StateId state = 0; state < 20; ++state) heap.Set(state, 7, 1);
  for (StateId state = 20; state-- > 0;) other.Set(state, static_cast<double>(state), 0);
  for (StateId state = 0; state < 20; ++state) other.Set(state, 7, 1);
  for (StateId state = 20; state-- > 0;) {
    EXPECT_EQ(heap.Pop(), state);
    EXPECT_EQ(other.Pop(), state);
  }
}

}  // namespace
}  // namespace planbench
