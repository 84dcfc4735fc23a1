# No file names a folder of somebody's machine.
set -euo pipefail
folders="work|farm|root|home|tmp|Users"
found=$(tools/list_files . | xargs -d '\n' grep -nIE "(^|[^[:alnum:]_.\$}-])/($folders)/" /dev/null | cut -c1-200 || true)
if [ -n "$found" ]; then
  echo "absolute paths of a machine:"
  echo "$found"
  exit 1
fi
