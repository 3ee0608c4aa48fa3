// Throughput of what ARA* does between collision checks: lattice states stored and retrieved, open
// edges pushed and popped.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "planner_ara/edge_heap.h"
#include "planner_ara/lattice.h"

namespace planbench {
namespace {

constexpr std::size_t kJoints = 8;
using Coordinates = std::array<Lattice::Coordinate, kJoints>;

// A walk of single steps over the lattice, as a search sees it: neighbours come close together, and
// many states are met again.
std::vector<Coordinates> Walk(std::size_t length) {
  std::mt19937 random(1);
  std::vector<Coordinates> states(1, Coordinates{});
  states.front().fill(180);
  while (states.size() < length) {
    Coordinates next =
        states[states.size() - 1 - random() % std::min<std::size_t>(states.size(), 10000)];
    next[random() % kJoints] += random() % 2 == 0 ? 20 : -20;
    states.push_back(next);
  }
  return states;
}

void StoreStates(benchmark::State& state) {
  const std::vector<Coordinates> walk = Walk(static_cast<std::size_t>(state.range(0)));
  std::size_t distinct = 0;
  for ([[maybe_unused]] auto _ : state) {
    LatticePoints points(kJoints);
    for (const Coordinates& coordinates : walk) points.FindOrAdd(coordinates);
    distinct = points.size();
    state.counters["bytes_per_state"] =
        static_cast<double>(points.bytes()) / static_cast<double>(distinct);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["distinct"] = static_cast<double>(distinct);
}
BENCHMARK(StoreStates)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void RetrieveStates(benchmark::State& state) {
  const std::vector<Coordinates> walk = Walk(static_cast<std::size_t>(state.range(0)));
  LatticePoints points(kJoints);
  for (const Coordinates& coordinates : walk) points.FindOrAdd(coordinates);
  for ([[maybe_unused]] auto _ : state) {
    for (const Coordinates& coordinates : walk) {
      benchmark::DoNotOptimize(points.Coordinates(points.FindOrAdd(coordinates)).data());
    }
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(RetrieveStates)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

// Thirty edges in for six out, as an expansion does.
void OpenEdges(benchmark::State& state) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<EdgeHeap::Entry> entries(1 << 12);
  for (EdgeHeap::Entry& entry : entries) entry = {unit(random), unit(random), 0, 1, 2};
  for ([[maybe_unused]] auto _ : state) {
    EdgeHeap heap;
    heap.Rebuild(
        100, EdgeOrder::kHeuristic, {}, [](const EdgeHeap::Entry&) { return true; },
        [] { return false; });
    std::size_t next = 0;
    for (int expansion = 0; expansion < state.range(0); ++expansion) {
      for (int i = 0; i < 30; ++i) heap.Push(entries[next++ % entries.size()]);
      for (int i = 0; i < 6; ++i) benchmark::DoNotOptimize(heap.Pop());
    }
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(OpenEdges)->Arg(100)->Arg(10'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace planbench

BENCHMARK_MAIN();
