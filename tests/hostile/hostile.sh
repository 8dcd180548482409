#!/usr/bin/env bash
# Attacks on what the program keeps, reads, cleans and writes; skipped without Python.   hostile.sh PROGRAM [ROUNDS [SEED]]
command -v python3 >/dev/null || { echo "no python3"; exit 77; }
exec python3 "$(dirname "$0")/hostile.py" "$@"
