// What a buffer's or an image's uri leads to: bytes written in the uri itself or a file beneath the glTF's own folder,
// and nothing else: no scheme, no absolute path, no way out of the folder (not through symbolic links either), no
// folder and no device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace brickfield {

/// Who asks, for messages and limits.
struct UriContext {
  std::string_view file;        ///< the glTF
  std::string_view element;     ///< "buffer 0"
  std::filesystem::path folder; ///< the glTF's own; empty: files are refused
  std::uint64_t limitBytes = 0;
};

/// True for "data:..."; such a uri never touches the disk.
bool isDataUri(std::string_view uri);

/// The file that a uri names, beneath `folder`; nothing where it holds the bytes itself or leads nowhere that is read.
/// The file need not exist.
std::optional<std::filesystem::path> fileOfUri(std::string_view uri, const std::filesystem::path& folder);

/// The bytes that a uri stands for.
///
/// mediaTypes what a data uri may call itself
/// error      BadInput: malformed, refused, missing, too large
std::vector<std::byte> readUri(std::string_view uri, const UriContext& context,
                               std::initializer_list<std::string_view> mediaTypes);

/// Strict base64 (RFC 4648): padding optional, no other characters. Nothing for malformed text.
/// proved by tests/unit/scene/gltf_uri_test.cpp
bool decodeBase64(std::string_view text, std::vector<std::byte>& bytes);

} // namespace brickfield
