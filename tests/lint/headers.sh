# Every header compiles alone. The build shows it of those that a source includes before all else (but for tests, which
# get others before); the others are compiled here. A build file of ninja remembers which of them, and what they include,
# are unchanged.
set -euo pipefail
folder=build/lint/headers
mkdir -p "$folder"
# As the include lines of sources name them: by their path within one of the folders that are searched.
tools/list_files '^(src|bakers|scenes)/.*\.cpp$' | xargs -n 1 grep -m 1 '^#' |
  sed -n 's/^#include "\(.*\)"$/\1/p' | sort -u >"$folder/shown_by_build"
is_shown() { printf '%s\n' "$1" "${1#src/}" "${1#shaders/}" "${1#scenes/}" | grep -qxFf "$folder/shown_by_build"; }
flags="-std=c++20 -fsyntax-only -Wall -Wextra -Werror -DBRICKFIELD_BAKERS=1 -DGLM_FORCE_DEPTH_ZERO_TO_ONE"
flags+=" -DGLM_FORCE_XYZW_ONLY -DGLM_ENABLE_EXPERIMENTAL -DBRICKFIELD_SOURCE_DIR='\"\"' -DBRICKFIELD_BINARY_DIR='\"\"'"
flags+=" -Isrc -Ishaders -I. -Iscenes $(pkg-config --cflags Imath epoxy egl)"
{
  echo "builddir = $folder"
  echo "rule header"
  echo "  command = printf '\$\#include \"%s\"\\n' \$in | \${CXX} -x c++ $flags -MMD -MF \$out.d -MT \$out - && touch \$out"
  echo "  depfile = \$out.d"
  echo "  description = \$in"
  tools/list_files '^(src|bakers|scenes|tests|shaders/shared)/.*\.h$' | while IFS= read -r header; do
    is_shown "$header" && continue
    echo "build $folder/$header.checked: header $header"
  done
} | sed "s|\${CXX}|${CXX:-c++}|; s|\$\\\\#|#|" >"$folder/build.ninja"
ninja -f "$folder/build.ninja" -j 2 -k 0 | { grep -vE '^\[[0-9]+/[0-9]+\]|^ninja: no work' || true; }
