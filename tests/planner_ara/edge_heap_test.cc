#include "planner_ara/edge_heap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

namespace planbench {
namespace {

using Entry = EdgeHeap::Entry;
using Rank = std::tuple<double, double, std::int64_t, int>;

Rank RankOf(const Entry& entry, double epsilon) {
  return {entry.g + epsilon * entry.h, entry.h, -static_cast<std::int64_t>(entry.source),
          entry.action};
}
const auto kAll = [](const Entry&) { return true; };
const auto kToTheEnd = [] { return false; };

// Few values, so that keys and ties meet; no two entries are equal.
Entry RandomEntry(std::mt19937* random, int number) {
  return {static_cast<double>((*random)() % 10), static_cast<double>((*random)() % 10),
          static_cast<float>((*random)() % 1000), static_cast<StateId>(number / 4),
          static_cast<std::uint16_t>(number % 4)};
}

void ExpectPopsInOrder(EdgeHeap* heap, std::vector<Entry> expected, double epsilon) {
  std::sort(expected.begin(), expected.end(), [epsilon](const Entry& a, const Entry& b) {
    return RankOf(a, epsilon) < RankOf(b, epsilon);
  });
  ASSERT_EQ(heap->size(), expected.size());
  for (const Entry& entry : expected) {
    ASSERT_EQ(RankOf(heap->top(), epsilon), RankOf(entry, epsilon));
    ASSERT_EQ(heap->top_key(), entry.g + epsilon * entry.h);
    ASSERT_EQ(RankOf(heap->Pop(), epsilon), RankOf(entry, epsilon));
  }
  EXPECT_TRUE(heap->empty());
}

TEST(EdgeHeap, PopsInOrderUnderRandomUse) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const double epsilon = 1 + seed % 5;
    EdgeHeap heap;
    heap.Rebuild(epsilon, EdgeOrder::kHeuristic, {}, kAll, kToTheEnd);
    std::vector<Entry> model;
    for (int step = 0; step < 2000; ++step) {
      if (random() % 3 != 0 || model.empty()) {
        const Entry entry = RandomEntry(&random, step);
        heap.Push(entry);
        model.push_back(entry);
      } else {
        const auto first =
            std::min_element(model.begin(), model.end(), [&](const Entry& a, const Entry& b) {
              return RankOf(a, epsilon) < RankOf(b, epsilon);
            });
        ASSERT_EQ(RankOf(heap.Pop(), epsilon), RankOf(*first, epsilon));
        model.erase(first);
      }
    }
    ExpectPopsInOrder(&heap, model, epsilon);
  }
}

TEST(EdgeHeap, RebuildTakesANewEpsilonMoreEntriesAndDropsOthers) {
  std::mt19937 random(1);
  EdgeHeap heap;
  heap.Rebuild(10, EdgeOrder::kHeuristic, {}, kAll, kToTheEnd);
  std::vector<Entry> expected;
  std::vector<Entry> more;
  const auto keep = [](const Entry& entry) { return entry.g < 7; };
  for (int i = 0; i < 600; ++i) {
    const Entry entry = RandomEntry(&random, i);
    if (i < 400) {
      heap.Push(entry);
    } else {
      more.push_back(entry);
    }
    if (keep(entry)) expected.push_back(entry);
  }
  heap.Rebuild(1.5, EdgeOrder::kHeuristic, more, keep, kToTheEnd);
  ExpectPopsInOrder(&heap, expected, 1.5);
}

TEST(EdgeHeap, ARebuildThatIsStoppedLosesNothing) {
  std::mt19937 random(3);
  const auto keep = [](const Entry& entry) { return entry.g < 7; };
  int num_stops = 0;
  for (int num_asked = 1;; ++num_asked) {
    EdgeHeap heap;
    std::vector<Entry> expected;
    std::vector<Entry> more;
    for (int i = 0; i < 5 * kStepsBetweenStops; ++i) {
      more.push_back(RandomEntry(&random, i));
      if (keep(more.back())) expected.push_back(more.back());
    }
    int budget = num_asked;
    const bool done =
        heap.Rebuild(3, EdgeOrder::kHeuristic, more, keep, [&] { return --budget == 0; });
    if (!done) {
      ASSERT_TRUE(heap.Rebuild(3, EdgeOrder::kHeuristic, {}, keep, kToTheEnd));
    }
    ExpectPopsInOrder(&heap, expected, 3);
    if (done) break;
    ++num_stops;
  }
  EXPECT_GT(num_stops, 5) << "in both passes";
}

TEST(EdgeHeap, RebuildCanOrderByTheGuide) {
  std::mt19937 random(2);
  EdgeHeap heap;
  for (int i = 0; i < 300; ++i) {
    Entry entry = RandomEntry(&random, i);
    entry.guide = static_cast<float>((i * 37) % 301);  // all different
    heap.Push(entry);
  }
  heap.Rebuild(4, EdgeOrder::kGuide, {}, kAll, kToTheEnd);
  double last = 0;
  while (!heap.empty()) {
    EXPECT_EQ(heap.top_key(), heap.top().g + 4 * static_cast<double>(heap.top().guide));
    EXPECT_GE(heap.top_key(), last);
    last = heap.top_key();
    heap.Pop();
  }
}

}  // namespace
}  // namespace planbench
