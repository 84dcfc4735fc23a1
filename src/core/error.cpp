// Builds the one-line messages of bad input.
#include "core/error.h"

namespace brickfield {

namespace {
// Text of a file may hold line breaks and control characters; a message is one printable line.
std::string onePrintableLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  constexpr std::size_t kLongestMessage = 1000;
  if (text.size() > kLongestMessage) text = text.substr(0, kLongestMessage) + "...";
  return text;
}
} // namespace

BadInput::BadInput(std::string_view subject, std::string_view element, std::string_view reason)
    : Error(onePrintableLine(std::string(subject) + ": " + std::string(element) + (element.empty() ? "" : ": ") +
                             std::string(reason))) {}

} // namespace brickfield
