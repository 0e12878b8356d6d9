// Two recordings side by side: how many seconds the second one begins after the first is in the
// address of the page, and in each question to the program.

const offset = new URLSearchParams(location.search).get("offset");

// The words of a question, to which the offset belongs.
export const query = (words = {}) => new URLSearchParams(offset === null ? words : {...words, offset});

// Shows the offset in `label`, a label with an input, and loads the page anew with another one.
// `beside` is what the program tells: {offset, recorded}, or nothing if there is one recording.
export function beside(label, told) {
  label.hidden = !told;
  if (!told) return;
  const input = label.querySelector("input");
  input.value = Number(told.offset.toFixed(6));
  label.title = `B began ${told.recorded.toFixed(3)} s after A when they were recorded`;
  input.onchange = () => {
    const wanted = Number(input.value);
    if (input.value === "" || !Number.isFinite(wanted)) return;
    location.assign(`/?${new URLSearchParams({offset: wanted})}${location.hash}`);
  };
}
