// Percent-decoding comes first, so that no escape hides a slash or a dot from the checks behind it.
#include "scene/gltf_uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/files.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::string> percentDecoded(std::string_view uri) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      decoded += uri[i];
      continue;
    }
    if (i + 2 >= uri.size()) return std::nullopt;
    const int high = hexDigit(uri[i + 1]), low = hexDigit(uri[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    decoded += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return decoded;
}

// RFC 3986: a letter, then letters, digits, '+', '-', '.' up to a colon.
bool hasScheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0 || !std::isalpha(static_cast<unsigned char>(uri[0]))) return false;
  return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

std::string shortened(std::string_view uri) {
  constexpr std::size_t kShown = 80;
  return std::string(uri.substr(0, kShown)) + (uri.size() > kShown ? "..." : "");
}

std::vector<std::byte> decodeDataUri(std::string_view uri, const UriContext& context,
                                     std::initializer_list<std::string_view> mediaTypes) {
  const auto refuse = [&](std::string_view reason) {
    throw BadInput(context.file, context.element, fmt::format("data uri \"{}\" {}", shortened(uri), reason));
  };
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) refuse("has no comma");
  std::string_view header = uri.substr(5, comma - 5);
  constexpr std::string_view kEncoding = ";base64";
  if (!header.ends_with(kEncoding)) refuse("is not base64");
  header.remove_suffix(kEncoding.size());
  if (header.ends_with(';') || header.find(";;") != std::string_view::npos) refuse("has an empty parameter");
  const std::string_view mediaType = header.substr(0, header.find(';'));
  if (std::find(mediaTypes.begin(), mediaTypes.end(), mediaType) == mediaTypes.end())
    refuse(fmt::format("has the media type \"{}\", which is none of {}", mediaType, fmt::join(mediaTypes, ", ")));
  const std::string_view payload = uri.substr(comma + 1);
  if (payload.size() / 4 * 3 > context.limitBytes) refuse("is too large");
  std::vector<std::byte> bytes;
  if (!decodeBase64(payload, bytes)) refuse("is not valid base64");
  return bytes;
}

// The file that a relative uri names; throws where it may not be read.
fs::path resolveInFolder(std::string_view uri, const UriContext& context) {
  const auto refuse = [&](std::string_view reason) {
    throw BadInput(context.file, context.element, fmt::format("uri \"{}\" {}", shortened(uri), reason));
  };
  if (hasScheme(uri)) refuse("has a scheme; only files beneath the glTF's folder are read");
  const std::optional<std::string> decoded = percentDecoded(uri);
  if (!decoded) refuse("has a broken percent escape");
  if (decoded->empty()) refuse("is empty");
  if (decoded->find('\0') != std::string::npos) refuse("holds a zero byte");
  if (decoded->find('\\') != std::string::npos) refuse("holds a backslash");
  if (hasScheme(*decoded)) refuse("has a scheme; only files beneath the glTF's folder are read");
  const fs::path relative(*decoded);
  if (relative.is_absolute()) refuse("is absolute; only files beneath the glTF's folder are read");
  for (const fs::path& part : relative)
    if (part == "..") refuse("leads out of the glTF's folder");
  if (context.folder.empty()) refuse("names a file, but this glTF has no folder");

  std::error_code ec;
  const fs::path root = fs::weakly_canonical(fs::absolute(context.folder, ec), ec);
  if (ec) refuse(ec.message());
  const fs::path target = fs::weakly_canonical(root / relative, ec);
  if (ec) refuse(ec.message());
  const auto [rootEnd, targetPart] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (rootEnd != root.end() || targetPart == target.end()) refuse("leads out of the glTF's folder");
  return target;
}

} // namespace

bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes) {
  bytes.clear();
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bitCount = 0;
  for (const char c : text) {
    const int digit = base64Digit(c);
    if (digit < 0) return false;
    bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xFFFFFF;
    bitCount += 6;
    if (bitCount >= 8) {
      bitCount -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> bitCount & 0xFF));
    }
  }
  return true;
}

std::optional<fs::path> fileOfUri(std::string_view uri, const fs::path& folder) {
  if (isDataUri(uri)) return std::nullopt;
  try {
    return resolveInFolder(uri, {"", "", folder, 0});
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

std::vector<std::byte> readUri(std::string_view uri, const UriContext& context,
                               std::initializer_list<std::string_view> mediaTypes) {
  if (isDataUri(uri)) return decodeDataUri(uri, context, mediaTypes);
  const fs::path path = resolveInFolder(uri, context);
  return readFile(path, context.limitBytes,
                  fmt::format("{}: {}: uri \"{}\"", context.file, context.element, shortened(uri)));
}

} // namespace brickfield
