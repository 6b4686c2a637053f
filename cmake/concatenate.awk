# Joins sources of tests into one. What each keeps to itself, in its unnamed namespace, goes into one that is named as the source.
FNR == 1 {
  name = FILENAME
  sub(/.*\//, "", name)
  sub(/\.cpp$/, "", name)
  print "#line 1 \"" FILENAME "\""
}
$0 == "namespace {" { $0 = "namespace only_in_" name " {" }
{ print }
