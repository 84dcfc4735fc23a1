# Every C++ file has the shape of .clang-format.
set -euo pipefail
tools/format --check
