// The URIs of glTF files.
#pragma once

#include <filesystem>
#include <string>

namespace ltcfit {

bool isDataUri(const std::string& uri);

/// The bytes of a base64 data URI of any media type; InputError with `name` if it is not one.
std::string dataOfUri(const std::string& uri, const std::string& name);

/// The file at a percent-encoded relative URI; InputError if the URI is absolute or has a scheme, or the file
/// is not there, no regular file or larger than 1 GiB.
std::string readRelative(const std::filesystem::path& folder, const std::string& uri);

/// For messages: at most 100 bytes of `text`, cut off between characters.
std::string shortened(const std::string& text);

}  // namespace ltcfit
