// Numbers in words and digits.

// Four digits, as in the tables of the report, with a true minus sign.
export function inDigits(value: number): string {
  if (!Number.isFinite(value)) return "–";
  const text = value === 0 ? "0" : Number(value.toPrecision(4)).toString();
  return text.replace("-", "−");
}

export function cyclesInWords(cycles: number | null): string {
  if (cycles === null) return "an unknown number of cycles";
  return cycles >= 1e6 ? `${inDigits(cycles / 1e6)} million cycles` : `${inDigits(cycles)} cycles`;
}
