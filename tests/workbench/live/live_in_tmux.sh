#!/usr/bin/env bash
# Runs the live view in an 80 x 24 terminal against a stand-in for the daemon, looks at the screen,
# presses q. Usage: live_in_tmux.sh SPOOLWATCH FAKE_DAEMON. Prints the screen when it is not right.
set -euo pipefail
spoolwatch=$1 fake_daemon=$2
url="udpm://239.255.76.67:$((20000 + $$ % 20000))?ttl=0"
folder=$(mktemp -d)
tmux=(tmux -S "$folder/tmux")
"$fake_daemon" "$url" 60 &
daemon=$!
trap 'kill $daemon 2>/dev/null || true; "${tmux[@]}" kill-server 2>/dev/null || true; rm -rf "$folder"' EXIT

"${tmux[@]}" new-session -d -x 80 -y 24 \
  "LC_ALL=C.UTF-8 '$spoolwatch' listen --live --lcm-url '$url'; echo \$? >'$folder/exit'; sleep 60"
for expected in "SPOOLWATCH  RUN  rig bench-1" "reference +" "position +" "sliding.b1" "period.b1" \
  "inside its band" "history" "late p99.9 18.4  max 61.2" "overruns 0" "none so far" "◆" "━"; do
  found=no
  for _ in $(seq 100); do
    "${tmux[@]}" capture-pane -p >"$folder/screen"
    if grep -qF -- "$expected" "$folder/screen"; then
      found=yes
      break
    fi
    sleep 0.1
  done
  if [ $found = no ]; then
    echo "not on the screen: $expected" >&2
    cat "$folder/screen" >&2
    exit 1
  fi
done
"${tmux[@]}" send-keys q
for _ in $(seq 100); do
  [ -s "$folder/exit" ] && break
  sleep 0.1
done
if [ "$(cat "$folder/exit")" != 0 ]; then
  echo "q ended the view with $(cat "$folder/exit")" >&2
  "${tmux[@]}" capture-pane -p -S - >&2
  exit 1
fi
