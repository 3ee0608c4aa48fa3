#include <chrono>
#include <iostream>
#include <thread>

#include "messaging/program.h"
#include "messaging/robot_flags.h"
#include "viewer/live_server.h"

int main(int argc, char** argv) {
  using namespace planbench;
  Program program("viewer",
                  "Shows what happens on a bus, or in a replay, as a page on this machine.");
  RobotFlags robot;
  int port = 8090;
  program.app().add_option("--robot", robot.folder,
                           "Robot folder; default: the one the session names");
  robot.AddPackagePaths(&program.app());
  program.app()
      .add_option("--port", port, "Port on 127.0.0.1; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  return program.Run(argc, argv, [&] {
    Bus bus(program.lcm_url());
    const LiveServer server(&bus, robot.folder, port, robot.Packages());
    bus.Start();
    std::cout << "viewer: " << server.url() << " shows " << bus.url() << std::endl;
    const auto stop = AwaitStopSignals();
    while (!stop()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return kExitOk;
  });
}
