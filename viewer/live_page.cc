#include "viewer/live_page.h"

#include <stdexcept>
#include <string_view>

#include "report/page.h"
#include "viewer/viewer_files.h"

namespace planbench {
namespace {

std::string_view File(std::string_view name) {
  for (const EmbeddedFile& file : ViewerFiles()) {
    if (file.name == name) return file.text;
  }
  throw std::logic_error("no file " + std::string(name) + " in viewer/web");
}

}  // namespace

std::string LivePage() { return PageWithViews(File("live.html"), "", File("live.js")); }

}  // namespace planbench
