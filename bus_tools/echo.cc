#include "bus_tools/echo.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <sstream>

#include "common/text.h"
#include "common/utf8.h"
#include "messaging/any_message.h"
#include "messaging/codec.h"

namespace planbench {
namespace {

std::string Cut(const std::string& line, std::size_t length) {
  if (length == 0) return line;
  std::string cut = FirstCharacters(line, length);
  return cut.size() < line.size() ? cut + "..." : cut;
}

std::string TimeOfDay(std::int64_t utime) {
  const std::chrono::microseconds time(utime);
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return fmt::format("{:%H:%M:%S}.{:03}", fmt::gmtime(std::time_t{seconds.count()}),
                     (time - seconds) / std::chrono::milliseconds(1));
}

}  // namespace

std::string EchoText(const ReceivedMessage& message, const EchoFormat& format) {
  std::string type;
  std::string fields;
  try {
    if (const auto printed = PrintAny(message.bytes, message.channel)) {
      type = printed->type;
      fields = printed->text;
    } else {
      type = "of no type that this version knows";
    }
  } catch (const MessageError& error) {
    type = "damaged";
    fields = error.what();
  }
  std::string text = fmt::format("{}  {}  {}, {} bytes\n", TimeOfDay(message.utime),
                                 Printable(message.channel), type, message.bytes.size());
  if (!format.fields) return text;
  std::istringstream lines(fields);
  std::size_t num_lines = 0;
  std::size_t num_left = 0;
  for (std::string line; std::getline(lines, line); ++num_lines) {
    if (format.max_lines > 0 && num_lines >= format.max_lines) {
      ++num_left;
    } else {
      text += "  " + Cut(line, format.max_line_length) + "\n";
    }
  }
  if (num_left > 0) text += fmt::format("  ... {} more lines\n", num_left);
  return text;
}

}  // namespace planbench
