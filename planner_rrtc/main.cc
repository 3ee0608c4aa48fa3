#include "messaging/planner_main.h"
#include "planner_rrtc/rrtc_planner.h"

int main(int argc, char** argv) {
  return planbench::PlannerMain(
      argc, argv, "rrtc", "RRT-Connect, or another of OMPL's planners, as a planbench planner.",
      planbench::MakeRrtcPlanner,
      {{"--algorithm", "algorithm",
        "RRT-Connect, or a geometric planner of OMPL (RRTConnect, RRTstar, BITstar, PRM, ...); an "
        "unknown name lists them all"}});
}
