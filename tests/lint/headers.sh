# Every header compiles alone. A build file of ninja remembers which headers, and what they include, are unchanged.
set -euo pipefail
folder=build/lint/headers
mkdir -p "$folder"
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
    echo "build $folder/$header.checked: header $header"
  done
} | sed "s|\${CXX}|${CXX:-c++}|; s|\$\\\\#|#|" >"$folder/build.ninja"
ninja -f "$folder/build.ninja" -j 2 -k 0 | { grep -vE '^\[[0-9]+/[0-9]+\]|^ninja: no work' || true; }
