// What a picture of floats shows: figures against the picture of the engine's own table, and what is wrong with it.

const luminance = (p, i) => 0.2126 * p[i] + 0.7152 * p[i + 1] + 0.0722 * p[i + 2];

// dark: the same scene with the lights off, so that only reflected light is measured and neither panel nor background.
export function measure(ours, theirs, dark) {
  if (ours.length === 0 || ours.length !== theirs.length || ours.length !== dark.length) {
    throw new Error(`pictures of ${ours.length}, ${theirs.length} and ${dark.length} floats`);
  }
  const pixels = ours.length / 4;
  const reflected = (p, i) => luminance(p, i) - luminance(dark, i);
  let mean = 0;
  for (let i = 0; i < ours.length; i += 4) mean += reflected(theirs, i) / pixels;

  const figures = { notFinite: 0, mean, lit: 0, strange: 0, meanDifference: 0, maxDifference: 0 };
  for (let i = 0; i < ours.length; i += 4) {
    const a = reflected(ours, i);
    const b = reflected(theirs, i);
    // black or white where the other is not: an engine's max(x, 0) or clamp hides a NaN so
    if (b > 0.25 * mean && !(a > b / 4 && a < 4 * b)) figures.strange += 1 / pixels;
    if (![0, 1, 2].every((c) => Number.isFinite(ours[i + c]))) {
      figures.notFinite++;
      continue;
    }
    if (a > 0.1 * mean) figures.lit += 1 / pixels;
    const difference = Math.abs(a - b) / mean;
    figures.meanDifference += difference / pixels;
    figures.maxDifference = Math.max(figures.maxDifference, difference);
  }
  return figures;
}

// Differences are in units of the mean reflected light. Measured: good tables 0.08 to 0.12 in the mean and 3 to 4.5 at
// most, where the edge of a highlight moves; misread ones 0.8 and more, 58 and more.
export const bounds = {
  lit: 0.3,                       // floor and the lit sides of the spheres are more than that of the picture
  strange: 0.001,                 // some pixels where light from below the horizon, in theirs, is black in ours
  meanDifference: [0.005, 0.25],  // below: the new table was never read
  maxDifference: 10,
};

// What a person would call wrong with the picture; empty if nothing.
export function problems(f) {
  const [least, most] = bounds.meanDifference;
  const found = [];
  if (f.notFinite > 0) found.push(`${f.notFinite} pixels not finite`);
  if (!(f.mean > 0)) found.push('the picture of its own table is dark');
  if (!(f.lit >= bounds.lit)) found.push(`only ${(100 * f.lit).toFixed(1)} % of the picture lit`);
  if (f.strange > bounds.strange) found.push(`${(100 * f.strange).toFixed(2)} % black or white where the other is not`);
  if (!(f.meanDifference >= least)) found.push('no difference from its own table');
  if (!(f.meanDifference <= most)) found.push(`mean difference ${f.meanDifference.toFixed(3)}`);
  if (!(f.maxDifference <= bounds.maxDifference)) found.push(`largest difference ${f.maxDifference.toFixed(2)}`);
  return found;
}
