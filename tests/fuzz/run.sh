# One fuzzer for so many seconds, from files that the program exports:
#   bash run.sh FUZZER FORMAT LTCFIT SEEDS SECONDS FOLDER
# FORMAT is npy, dds, ktx2, exr, text or scene; SEEDS the program that writes further EXR files, or the folder of the
# scenes; FOLDER is made anew.
set -eu
fuzzer=$1 format=$2 ltcfit=$3 seeds=$4 seconds=$5 folder=$6
rm -rf "$folder"
mkdir -p "$folder/seeds" "$folder/corpus"
cd "$folder"
if [ "$format" = scene ]; then
  cp "$seeds"/*.g* "$seeds"/*.png "$seeds"/*.jpg "$seeds"/*.json seeds/
  # a PNG of one bit a texel may have 8256 for each of its bytes, and each becomes 4
  exec "$fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=208 -max_len=6144 \
    -print_final_stats=1 corpus seeds
fi
"$ltcfit" fit iso --size 4x4 --lights 32 -q -o iso.json
"$ltcfit" fit aniso --size 2x2x2x2 --lights 32 -q -o aniso.json
export_table() { "$ltcfit" export "$1.json" --format "$format" -q -o "seeds/$1$2.$format" "${@:3}"; }
for kind in iso aniso; do
  case $format in
    npy | dds | ktx2 | exr)
      export_table $kind ""
      export_table $kind -half --precision half
      if [ "$format" = ktx2 ]; then export_table $kind -plain --uncompressed; fi
      if [ "$format" = dds ]; then export_table $kind -legacy --dds-header legacy; fi
      ;;
    text)
      cp $kind.json seeds/
      for source in h js; do "$ltcfit" export $kind.json --format $source -q -o seeds/$kind.$source; done
      "$ltcfit" export $kind.json --format bin -q -o $kind.bin
      cp $kind.bin.json seeds/
      if [ $kind = iso ]; then
        "$ltcfit" export $kind.json --format chebyshev --coefficients 96 -q -o cheb && cp cheb.cheb.json seeds/
      fi
      ;;
  esac
done
if [ "$format" = exr ]; then "$seeds" seeds; fi
if [ "$format" != text ]; then rm -f seeds/*.json; fi  # sidecars
# No reader was seen to take a second. An allocation may be 1032 times the file's length (EXR): of 64 KiB
exec "$fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=68 -max_len=65536 \
  -print_final_stats=1 corpus seeds
