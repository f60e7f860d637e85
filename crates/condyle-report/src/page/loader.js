// Runs the program that stands in the page, compressed.
{
  const text = document.getElementById("program").textContent;
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  new Response(stream).text().then((text) => {
    const program = document.createElement("script");
    program.textContent = text;
    document.body.append(program);
  });
}
