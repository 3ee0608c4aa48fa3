#include "messaging/robot_flags.h"

#include "geometry/mesh_loader.h"

namespace planbench {

std::vector<CLI::Option*> RobotFlags::AddTo(CLI::App* app) {
  return {app->add_option("--robot", folder, "robot folder, or the name of a robot that ships"),
          app->add_option("--spheres", spheres,
                          "file of spheres that take the place of the robot folder's `spheres`"),
          AddPackagePaths(app)};
}

CLI::Option* RobotFlags::AddPackagePaths(CLI::App* app) {
  return app
      ->add_option("--package-path", package_paths,
                   "NAME=DIR: folder that package://NAME/ stands for; repeatable")
      ->allow_extra_args(false);
}

std::map<std::string, std::filesystem::path> RobotFlags::Packages() const {
  return ParsePackagePaths(package_paths);
}

std::vector<std::string> RobotFlags::Arguments() const {
  std::vector<std::string> arguments = {"--robot", folder.string()};
  if (!spheres.empty()) arguments.insert(arguments.end(), {"--spheres", spheres.string()});
  for (const std::string& package : package_paths) {
    arguments.insert(arguments.end(), {"--package-path", package});
  }
  return arguments;
}

}  // namespace planbench
