#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace planbench {

/// An attribute of a tag, as written.
struct XmlAttribute {
  std::string_view name;
  std::string_view value;  ///< Between the quotes.
};

/// A tag of XML text.
struct XmlTag {
  std::string_view text;     ///< From '<' to before '>'.
  std::string_view element;  ///< Its name.
  int line = 1;              ///< From 1.
  bool closing = false;      ///< </element>
  bool empty = false;        ///< <element/>

  /// In order, up to what is no attribute.
  std::vector<XmlAttribute> Attributes() const;
  /// The value of an attribute with characters for XML's own entities (`&amp;`), as parsers give
  /// it; nothing if the tag has none of that name.
  std::optional<std::string> Attribute(std::string_view name) const;
};

/// The start and end tags of XML text, in order; comments, declarations and character data are
/// passed over. Goes on as well as it can in text that is not well-formed. Refers to the text.
class XmlTagReader {
 public:
  explicit XmlTagReader(std::string_view text) : text_(text) {}

  std::optional<XmlTag> Next();

 private:
  XmlTag Read();

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t counted_ = 0;  // Lines up to here are counted.
  int line_ = 1;
};

/// The numbers of an attribute's value; nothing if a word of it is none.
std::optional<std::vector<double>> ReadNumbers(std::string_view value);

/// Refuses (InputError with file and line) what XML parsers pass over in silence, or report without
/// a place: text that is no UTF-8, control characters in tags, in names also ends of lines and
/// references to characters, definitions of entities, text before the first element, elements that
/// are not closed or follow the outermost one, what is no attribute, and what xacro or XInclude
/// would have to expand first. `origin` names the text.
void CheckXmlText(std::string_view text, const std::string& origin);

}  // namespace planbench
