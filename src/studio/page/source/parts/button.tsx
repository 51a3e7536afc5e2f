// Buttons with an icon: the name is for readers of the screen, the key stands in the tooltip.

import { Icon } from "./icon.tsx";

interface Props {
  icon: string;
  name: string;
  keys?: string;
  isPressed?: boolean;
  isDisabled?: boolean;
  act: () => void;
}

export function IconButton({ icon, name, keys, isPressed, isDisabled, act }: Props) {
  return (
    <button
      class="icon-button"
      aria-label={name}
      title={keys ? `${name} (${keys})` : name}
      aria-pressed={isPressed}
      aria-keyshortcuts={keys?.length === 1 ? keys : undefined}
      disabled={isDisabled}
      onClick={act}
    >
      <Icon name={icon} />
    </button>
  );
}
