#include "messaging/planner_main.h"
#include "planner_trajopt/trajopt_planner.h"

int main(int argc, char** argv) {
  return planbench::PlannerMain(
      argc, argv, "trajopt", "Trajectory optimisation, STOMP or CHOMP, as a planbench planner.",
      planbench::MakeTrajoptPlanner, {{"--algorithm", "algorithm", "STOMP or CHOMP"}});
}
