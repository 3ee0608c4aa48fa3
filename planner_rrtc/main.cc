#include "messaging/planner_main.h"
#include "planner_rrtc/rrtc_planner.h"

int main(int argc, char** argv) {
  return planbench::PlannerMain(argc, argv, "rrtc", "RRT-Connect (OMPL) as a planbench planner.",
                                planbench::MakeRrtcPlanner);
}
