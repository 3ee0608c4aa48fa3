#include "messaging/planner_main.h"
#include "planner_ara/ara_planner.h"

int main(int argc, char** argv) {
  return planbench::PlannerMain(argc, argv, "ara",
                                "ARA* over a motion-primitive lattice as a planbench planner.",
                                planbench::MakeAraPlanner);
}
