// The scene's own text: what the page does, written out, and open to being written.

import { useEffect, useState } from "preact/hooks";
import { copyCommand, replaceText } from "../model/scene.ts";
import { useStudio } from "../model/store.ts";

export function ScenePanel() {
  const toml = useStudio((state) => state.scene?.toml ?? "");
  const file = useStudio((state) => state.scene?.file ?? "");
  const command = useStudio((state) => state.scene?.command ?? "");
  const [text, setText] = useState<string | null>(null);
  const [fault, setFault] = useState<string | null>(null);
  useEffect(() => setFault(null), [toml]);
  const isChanged = text !== null && text !== toml;
  const save = async () => {
    if (text === null) return;
    const error = await replaceText(text);
    setFault(error);
    if (error === null) setText(null);
  };
  const key = (event: KeyboardEvent) => {
    if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) (event.preventDefault(), void save());
  };
  return (
    <>
      <p class="lead">Everything done here is this file. An editor may change it too; the page follows.</p>
      <label class="field" for="scene-text">
        {file}
      </label>
      <textarea id="scene-text" class="code" spellcheck={false} value={text ?? toml} onInput={(event) => setText(event.currentTarget.value)} onKeyDown={key} aria-invalid={fault !== null} />
      {fault && (
        <p class="failure" role="alert">
          {fault}
        </p>
      )}
      <div class="buttons">
        <button class="primary" disabled={!isChanged} title="Ctrl+Enter" onClick={() => void save()}>
          Apply
        </button>
        <button disabled={!isChanged} onClick={() => (setText(null), setFault(null))}>
          Revert
        </button>
      </div>
      <p class="field">As a command</p>
      <pre class="code command" tabIndex={0} aria-label="The command">
        {command}
      </pre>
      <div class="buttons">
        <button onClick={() => void copyCommand()}>Copy command</button>
      </div>
    </>
  );
}
