// Sets every formula of pages and of documentation comments: formulas.cjs FILE...
//
// A formula stands between $ and $, or $$ and $$ on a line of its own. Before KaTeX sees it, Markdown does; so what
// Markdown would turn into something else is refused here as well.
const fs = require("fs");
const katex = require("katex");

const REFUSED = [
  [/\\[!-/:-@[-`{-~]/, "Markdown takes the backslash away"],
  [/['"]|--|\.\.\./, "Markdown makes typographic signs of this"],
  [/\*/, "Markdown makes emphasis of *; use \\cdot or \\times"],
  [/(^|[^0-9A-Za-z])_/, "Markdown makes emphasis of _ unless it follows a letter or a digit"],
  [/<(?! )/, "Markdown makes a tag of < unless a space follows"],
  [/[[\]]/, "Markdown makes a link of brackets"],
  [/\n[ ]*([-+=>#]|[0-9]+\.)/, "Markdown begins something else at the start of this line"],
];

// The prose of a file, paragraph by paragraph, each with its line: code is blanked.
function paragraphs(file) {
  let text = fs.readFileSync(file, "utf8");
  if (file.endsWith(".rs")) {
    const comment = (line) => (/^\s*\/\/[/!] ?(.*)/.exec(line) || [, ""])[1];
    text = text.split("\n").map(comment).join("\n");
  }
  const blank = (code) => code.replace(/[^\n]/g, " ");
  text = text.replace(/^```[^]*?^```/gm, blank).replace(/`[^`]*`/g, blank);
  let line = 1;
  return text.split(/(\n\s*\n)/).flatMap((paragraph) => {
    const here = { file, line, text: paragraph };
    line += paragraph.split("\n").length - 1;
    return paragraph.trim() ? [here] : [];
  });
}

function problemsOf(paragraph, counted) {
  const parts = paragraph.text.split(/(\$\$?)/);
  const problems = [];
  let open = null;
  for (let i = 0; i < parts.length; i += 2) {
    const mark = parts[i + 1];
    if (open) {
      if (mark !== open) return [`a formula begins with ${open} and does not end: ${parts[i].trim()}`];
      counted.formulas += 1;
      problems.push(...problemsOfFormula(parts[i], open === "$$"));
      open = null;
    } else open = mark || null;
  }
  return problems;
}

function problemsOfFormula(formula, displayMode) {
  const refused = REFUSED.filter(([pattern]) => pattern.test(formula)).map(([, why]) => why);
  try {
    katex.renderToString(formula, { displayMode, strict: "error", throwOnError: true });
  } catch (error) {
    refused.push(error.message);
  }
  return refused.map((why) => `${formula.trim()}: ${why}`);
}

const counted = { formulas: 0 };
let wrong = 0;
for (const paragraph of process.argv.slice(2).flatMap(paragraphs)) {
  for (const problem of problemsOf(paragraph, counted)) {
    wrong += 1;
    console.log(`${paragraph.file}:${paragraph.line}: ${problem}`);
  }
}
console.log(`${counted.formulas} formulas, ${wrong} problems`);
process.exit(wrong ? 1 : 0);
