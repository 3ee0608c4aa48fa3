#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "tests/support/child_process.h"

namespace planbench {

inline std::optional<std::string> FindBrowser() {
  for (const char* name :
       {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"}) {
    if (std::filesystem::exists(name)) return name;
  }
  return std::nullopt;
}

inline std::string FromBase64(const std::string& text) {
  std::string decoded;
  unsigned bits = 0;
  int num_bits = 0;
  for (const char c : text) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<unsigned>(digit);
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    decoded += static_cast<char>(bits >> num_bits & 0xff);
  }
  return decoded;
}

/// What a page's script can ask of a 3D view's canvas: its pixels (without another,
/// `view`'s), and in how many two pictures differ.
inline constexpr char kPixels[] = R"script(
  const pixels = (canvas = view.canvas) => {
    const copy = document.createElement("canvas");
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    return new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  };
  const differing = (a, b) => a.reduce((sum, pixel, i) => sum + (pixel !== b[i]), 0);
)script";

/// Opens a page in a real browser that has no network, and evaluates `probe`, statements that fill
/// the object `found`, once it has loaded. Expects a clean console and no request.
inline nlohmann::json Browse(const std::filesystem::path& page, const std::string& probe) {
  std::ofstream(page, std::ios::app)
      << "<script>addEventListener('load', () => { const found = {};\n"
      << probe
      << "\nfound.requests = performance.getEntriesByType('resource').length;\n"
         "const probe = document.createElement('pre');\n"
         "probe.textContent = 'PROBE' + "
         "btoa(unescape(encodeURIComponent(JSON.stringify(found)))) + '.';\n"
         "document.body.append(probe); });</script>";
  ChildProcess browser({*FindBrowser(), "--headless", "--no-sandbox", "--disable-dev-shm-usage",
                        "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                        "--enable-logging=stderr", "--host-resolver-rules=MAP * ~NOTFOUND",
                        "--user-data-dir=" + page.string() + ".profile", "--window-size=1200,900",
                        "--virtual-time-budget=20000", "--dump-dom", "file://" + page.string()},
                       page.string() + ".browser");
  EXPECT_EQ(browser.Wait(), 0);
  std::istringstream log(browser.Errors());
  for (std::string line; std::getline(log, line);) {
    // What the software renderer says of reading its picture back is not the page's.
    const bool of_driver = line.find("GL Driver Message") != std::string::npos;
    EXPECT_TRUE(of_driver || line.find("CONSOLE") == std::string::npos) << line;
  }
  const std::string dom = browser.Output();
  const std::size_t begin = dom.find("<pre>PROBE");
  if (begin == std::string::npos) {
    ADD_FAILURE() << "the page did not load: " << browser.Errors();
    return {};
  }
  nlohmann::json found = nlohmann::json::parse(FromBase64(dom.substr(begin + 10)));
  EXPECT_EQ(found["requests"], 0);
  return found;
}

}  // namespace planbench
