#!/bin/sh
# Makes the parsers of the grammars, runs their tests, and reads every shipped program and programs of later controls with
# them; looks whether the extension of Visual Studio Code can be read. Needs tree-sitter (cargo install tree-sitter-cli
# --locked), a C compiler and node; says what it skips.
set -e
cd "$(dirname "$0")"
if command -v tree-sitter >/dev/null 2>&1; then
	for grammar in plain plc; do
		cd "tree-sitter-$grammar"
		tree-sitter generate
		tree-sitter test
		case $grammar in
		plain) files=$(find ../../examples ../../machines test/programs -name '*.[Hh]') ;;
		plc) files=$(find ../../examples ../../machines -name '*.plc' -o -name '*.PLC') ;;
		esac
		for file in $files; do
			tree-sitter parse --quiet "$file" >/dev/null 2>&1 || { echo "$file cannot be read by tree-sitter-$grammar"; exit 1; }
		done
		echo "tree-sitter-$grammar reads $(echo "$files" | wc -l) files"
		cd ..
	done
else
	echo "skipped: tree-sitter is not installed"
fi
if command -v node >/dev/null 2>&1; then
	node --check vscode/extension.js
	for file in vscode/*.json tree-sitter-*/tree-sitter.json; do
		node -e 'JSON.parse(require("fs").readFileSync(process.argv[1], "utf8"))' "$file"
	done
	echo "the extension of Visual Studio Code can be read"
else
	echo "skipped: node is not installed"
fi
