// How a page of the player shows an item, answers it as a person would, and says what came of it.
window.shown = async (xml) => {
  document.body.innerHTML = "<qti-item><item-container></item-container></qti-item>";
  const container = document.querySelector("item-container");
  await container.updateComplete;
  const connected = new Promise((resolve, reject) => {
    document.addEventListener("qti-assessment-item-connected", (event) => resolve(event.detail), { once: true });
    setTimeout(() => reject(new Error("no item after 30 s")), 30000);
  });
  container.itemXML = xml;
  window.item = await connected;
  return item.querySelector("qti-item-body").textContent.length;
};

window.typed = {
  "qti-text-entry-interaction": (field, value) => {
    const input = field.shadowRoot.querySelector("input");
    input.value = value;
    input.dispatchEvent(new Event("change"));
  },
  "qti-inline-choice-interaction": (field, value) => {
    field.shadowRoot.querySelector("[part=trigger]").click();
    field.querySelector(`[identifier="${value}"]`).click();
  },
  "qti-choice-interaction": (field, value) => {
    for (const choice of [value].flat()) field.querySelector(`[identifier="${choice}"]`).click();
  },
  "qti-match-interaction": (field, value) => {
    for (const pair of value) field.shadowRoot.querySelector(`input[value="${pair}"]`).click();
  },
  "qti-order-interaction": (field, value) => {
    field.response = value;
    field.saveResponse();
  },
};

// With the fields of the page.
window.answered = async (given) => {
  for (const [name, value] of Object.entries(given)) {
    const field = item.querySelector(`[response-identifier="${name}"]`);
    typed[field.localName](field, value);
    await field.updateComplete;
  }
  return said();
};

// The same without the page, so that many answers can be tried.
window.tried = (given) => {
  for (const one of item.variables.filter((variable) => variable.type === "response"))
    item.updateResponseVariable(one.identifier, given[one.identifier] ?? null);
  return said();
};

window.said = () => {
  // What was shown before is closed, as a person does: the player itself leaves it open.
  for (const one of item.querySelectorAll("qti-modal-feedback")) one.showStatus = "off";
  item.processResponse(true, false);
  const shown = [...item.querySelectorAll("qti-modal-feedback")].filter((one) => one.showStatus === "on");
  return [
    Number(item.variables.find((one) => one.identifier === "SCORE").value),
    shown.map((one) => [one.outcomeIdentifier, one.textContent.replace(/\s+/g, " ").trim()]),
  ];
};
