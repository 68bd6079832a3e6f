#!/bin/sh
# The JKR pull-off force of a paraboloid, (3 + k) / 2, as a program that speaks JSON lines.

number() { # the number that a request has under a key
    printf '%s\n' "$request" | sed -n "s/.*\"$1\": *\([-+0-9.eE]*\).*/\1/p"
}

while read -r request; do
    case $request in
    *'"describe"'*)
        echo '{"name": "jkr-sh", "version": "1", "citation": "JKR (1971)", "domain": "n = 2, 0 <= k <= 0.9",' \
            '"applies_to": {"quantities": ["pull_off_force"], "n": [2, 2], "k": [0, 0.9], "mu": [0.01, null]}}'
        ;;
    *'"pull_off_force"'*)
        awk -v n="$(number n)" -v k="$(number k)" 'BEGIN {
            if (n != 2) print "{\"status\": \"not-applicable\", \"reason\": \"the model is for n = 2\"}"
            else printf "{\"status\": \"ok\", \"value\": %.17g, \"u_num\": 1e-15}\n", (3 + k) / 2
        }'
        ;;
    *)
        echo '{"status": "not-applicable", "reason": "the model has no equation for it"}'
        ;;
    esac
done
