# For scripts that print tables: value DIR GROUP KEY is the value of a key in one of the groups of DIR/score.json.
value() {
  sed -n "/^  \"$2\": {/,/^  }/s/^ *\"$3\": *\([^,]*\),\{0,1\}$/\1/p" "$1/score.json" | head -n 1
}
