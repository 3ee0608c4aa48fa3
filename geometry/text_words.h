#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace planbench {

/// The lines of a text, whichever of \n, \r\n and \r ends them. Refers to the text.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}

  /// The next line without its end; nothing after the last.
  std::optional<std::string_view> Next();
  /// Of the line that came last, from 1.
  int number() const { return number_; }

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// Takes the first word, apart from others by spaces and tabs, off a line; "" if it has none.
std::string_view TakeWord(std::string_view* line);

/// A number as printf and people write it (1e-3, .5, 2., +1), whatever the locale; nothing if the
/// word is none.
std::optional<double> ParseNumber(std::string_view word);

std::string LowerCase(std::string_view text);

}  // namespace planbench
