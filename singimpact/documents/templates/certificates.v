(* What the theorems of emitted certificates use: lemmas, tactics, and polynomials whose normal forms Coq computes. *)

From Coq Require Import Reals Lra Lia List QArith Qreals Ring.
Import ListNotations.
Open Scope R_scope.

(* rational numbers as coefficients of `ring`: it knows integers alone *)
Definition number (q : Q) : R := match Qden q with xH => IZR (Qnum q) | p => IZR (Qnum q) / IZR (Zpos p) end.
Lemma number_is q : number q = Q2R q.
Proof. destruct q as [z p]. unfold number, Q2R. simpl. destruct p; try reflexivity. field. Qed.
Definition add a b := Qred (a + b). Definition mul a b := Qred (a * b).
Definition sub a b := Qred (a - b). Definition opp a := Qred (- a).
Lemma number_red q x : Q2R q = x -> number (Qred q) = x.
Proof. intro H. rewrite number_is, <- H. apply Qeq_eqR, Qred_correct. Qed.
Lemma numbers : ring_morph 0 1 Rplus Rmult Rminus Ropp (@eq R) 0%Q 1%Q add mul sub opp Qeq_bool number.
Proof.
  constructor; intros; try reflexivity; try (apply number_red; rewrite !number_is).
  - apply Q2R_plus. - apply Q2R_minus. - apply Q2R_mult. - apply Q2R_opp.
  - rewrite !number_is. apply Qeq_eqR, Qeq_bool_eq. assumption.
Qed.
Ltac no := constr:(InitialRing.NotConstant).
Ltac number_of t := match t with
  | IZR ?z => match isZcst z with true => constr:(z # 1) | _ => no end
  | IZR ?z / IZR (Zpos ?p) => match isZcst z with true => match isPcst p with true => constr:(z # p) | _ => no end | _ => no end
  | _ => no
  end.


Add Ring over_Q : RTheory (morphism numbers, constants [number_of], power_tac R_power_theory [Rpow_tac]).

(* ---- signs: a sum of products of positive numbers, up to a positive factor *)

Lemma above_0 f n : 0 < f -> n * f > 0 -> n > 0.
Proof. intros F H. apply Rnot_le_gt. intro C. nra. Qed.
Lemma below_0 f n : 0 < f -> - n * f > 0 -> n < 0.
Proof. intros F H. assert (W := above_0 f (- n) F H). lra. Qed.
Lemma quotient_sign n d : n * d > 0 -> n / d > 0.
Proof.
  intro H. assert (d <> 0) by (intro E; rewrite E in H; lra).
  replace (n / d) with (n * d * (/ d * / d)) by (field; assumption).
  assert (0 < / d * / d) by (assert (W := Rinv_neq_0_compat d ltac:(assumption)); nra). nra.
Qed.
Lemma above_0_quotient f n d : 0 < f -> n * d * f > 0 -> n / d > 0.
Proof. intros F H. apply quotient_sign, (above_0 f); assumption. Qed.
Lemma below_0_quotient f n d : 0 < f -> - (n * d) * f > 0 -> n / d < 0.
Proof.
  intros F H. assert (W := quotient_sign (- n) d). assert (V := above_0 f (- n * d) F).
  replace (- (n * d) * f) with (- n * d * f) in H by ring. specialize (W (V H)). unfold Rdiv in *. nra.
Qed.

Ltac pos := match goal with
  | |- _ + _ > 0 => apply Rplus_lt_0_compat; pos
  | |- 0 < _ + _ => apply Rplus_lt_0_compat; pos
  | |- _ * _ > 0 => apply Rmult_lt_0_compat; pos
  | |- 0 < _ * _ => apply Rmult_lt_0_compat; pos
  | |- 0 < _ ^ _ => apply pow_lt; pos
  | |- _ ^ _ > 0 => apply pow_lt; pos
  | _ => lra
  end.

Lemma definite_above a b c x y : 0 < a -> b * b < 4 * a * c -> x <> 0 \/ y <> 0 -> a * x ^ 2 + b * x * y + c * y ^ 2 > 0.
Proof.
  intros A B H. apply (above_0 (4 * a)); [lra|].
  replace ((a * x ^ 2 + b * x * y + c * y ^ 2) * (4 * a)) with ((2 * a * x + b * y) ^ 2 + (4 * a * c - b * b) * y ^ 2) by ring.
  destruct (Req_dec y 0) as [E|E].
  - subst. destruct H as [H|H]; [|lra]. assert (0 < x * x) by (apply Rsqr_pos_lt; exact H).
    replace ((2 * a * x + b * 0) ^ 2 + (4 * a * c - b * b) * 0 ^ 2) with (4 * (a * a) * (x * x)) by ring.
    apply Rmult_lt_0_compat; [nra|assumption].
  - assert (0 < y * y) by (apply Rsqr_pos_lt; exact E).
    assert (0 <= (2 * a * x + b * y) ^ 2) by (rewrite <- Rsqr_pow2; apply Rle_0_sqr).
    replace (y ^ 2) with (y * y) by ring. assert (0 < (4 * a * c - b * b) * (y * y)) by (apply Rmult_lt_0_compat; lra). lra.
Qed.
Lemma definite_below a b c x y : a < 0 -> b * b < 4 * a * c -> x <> 0 \/ y <> 0 -> a * x ^ 2 + b * x * y + c * y ^ 2 < 0.
Proof.
  intros A B H. assert (B' : - b * - b < 4 * - a * - c) by (ring_simplify; ring_simplify in B; lra).
  assert (W := definite_above (- a) (- b) (- c) x y ltac:(lra) B' H). lra.
Qed.

(* ---- equations where a relation holds *)

Lemma by_relation left right a b p q m c r :
  left = a / b -> right = p / q -> b <> 0 -> q <> 0 -> m <> 0 -> r = 0 -> m * (a * q - p * b) = c * r -> left = right.
Proof.
  intros L R B Q M Z H. rewrite L, R. rewrite Z in H. assert (E : a * q = p * b) by nra.
  apply (Rmult_eq_reg_r (b * q)); [|now apply Rmult_integral_contrapositive_currified].
  replace (a / b * (b * q)) with (a * q) by (field; assumption). rewrite E. field. assumption.
Qed.
Lemma by_relation_to_order left right rest a b p q m c r d :
  left = a / b -> right = p / q -> rest = d / (m * b * q) -> b <> 0 -> q <> 0 -> m <> 0 -> r = 0 ->
  m * (a * q - p * b) = c * r + d -> left = right + rest.
Proof.
  intros L R T B Q M Z H. rewrite L, R, T. rewrite Z in H. assert (E : m * (a * q) = m * (p * b) + d) by lra.
  apply (Rmult_eq_reg_r (m * b * q)); [|repeat apply Rmult_integral_contrapositive_currified; assumption].
  replace (a / b * (m * b * q)) with (m * (a * q)) by (field; assumption). rewrite E. field. auto.
Qed.

(* ---- limits *)

Lemma limit_at (f : R -> R) a l : continuity_pt f a -> f a = l -> limit1_in f (D_x no_cond a) l a.
Proof. intros C E. rewrite <- E. exact C. Qed.
Lemma limit_towards (g f : R -> R) (D : R -> Prop) l :
  (forall u, D u -> u <> 0 /\ f u = g u) -> continuity_pt g 0 -> g 0 = l -> limit1_in f D l 0.
Proof.
  intros H C E eps He. destruct (C eps He) as [d [Hd W]]. exists d. split; [exact Hd|].
  intros u [Du Near]. destruct (H u Du) as [N F]. rewrite F, <- E. apply W. split; [|exact Near].
  split; [exact I|]. auto.
Qed.

Ltac continuous := match goal with
  | |- continuity_pt (fun x => ?c) ?a => apply continuity_pt_const; now intros
  | |- continuity_pt (fun x => x) ?a => apply derivable_continuous_pt, derivable_pt_id
  | |- continuity_pt (fun x => @?f x + @?g x) ?a => apply (continuity_pt_plus f g a); continuous
  | |- continuity_pt (fun x => @?f x - @?g x) ?a => apply (continuity_pt_minus f g a); continuous
  | |- continuity_pt (fun x => @?f x * @?g x) ?a => apply (continuity_pt_mult f g a); continuous
  | |- continuity_pt (fun x => @?f x / @?g x) ?a => apply (continuity_pt_div f g a); [continuous | continuous | cbv beta]
  | |- continuity_pt (fun x => - @?f x) ?a => apply (continuity_pt_opp f a); continuous
  | |- continuity_pt (fun x => x ^ ?n) ?a => apply derivable_continuous_pt, derivable_pt_pow
  end.
(* what `field` asks of denominators, which may be parts of those that are not 0 *)
Ltac nonzero := repeat split; first [exact I | assumption | lra | match goal with
  | H : ?p <> 0 |- ?q <> 0 =>
      let E := fresh in intro E; apply H; first [lra | (rewrite E; field) | nra | (rewrite E; nra) | (field_simplify_eq; [lra | nonzero])]
  end].

(* ---- roots of a polynomial, given by the list of its coefficients *)

Fixpoint eval (l : list R) (x : R) : R := match l with [] => 0 | a :: t => a + x * eval t x end.
Fixpoint alternate (l : list R) : list R := match l with [] => [] | a :: t => a :: map Ropp (alternate t) end.

Lemma eval_continuous l x : continuity_pt (eval l) x.
Proof.
  induction l as [|a t IH]; [apply continuity_pt_const; now intros|].
  apply (continuity_pt_plus (fun _ => a) (fun y => y * eval t y)); [apply continuity_pt_const; now intros|].
  apply (continuity_pt_mult (fun y => y) (eval t)); [apply derivable_continuous_pt, derivable_pt_id|exact IH].
Qed.

Lemma root_between l a b : a < b -> eval l a * eval l b < 0 -> exists x, a < x < b /\ eval l x = 0.
Proof.
  intros H S. destruct (IVT_cor (eval l) a b) as [x [Hx E]]; [intro; apply eval_continuous|lra|lra|].
  exists x. split; [|exact E]. destruct Hx as [[A|A] [B|B]]; subst; split; try assumption; nra.
Qed.

Lemma eval_opp l x : eval (map Ropp l) x = - eval l x.
Proof. induction l as [|a t IH]; simpl; [ring|]. rewrite IH. ring. Qed.
Lemma eval_alternate l x : eval (alternate l) x = eval l (- x).
Proof. induction l as [|a t IH]; simpl; [reflexivity|]. rewrite eval_opp, IH. ring. Qed.
Lemma last_opp l : last (map Ropp l) 0 = - last l 0.
Proof. induction l as [|a [|b t] IH]; simpl in *; [ring|reflexivity|exact IH]. Qed.

Lemma far l : 0 < last l 0 -> exists X m, 0 < m /\ forall x, X <= x -> m <= eval l x.
Proof.
  induction l as [|a t IH]; [simpl; lra|]. destruct t as [|b t].
  - simpl. intro H. exists 0, a. split; [exact H|]. intros. lra.
  - intro H. destruct IH as [X [m [M W]]]; [exact H|].
    exists (Rmax X (Rmax 0 ((m - a) / m))), m. split; [exact M|]. intros x Hx.
    assert (A := Rle_trans _ _ _ (Rmax_l _ _) Hx). assert (B := Rle_trans _ _ _ (Rmax_r _ _) Hx).
    assert (C := Rle_trans _ _ _ (Rmax_l _ _) B). assert (D := Rle_trans _ _ _ (Rmax_r _ _) B).
    specialize (W x A). change (eval (a :: b :: t) x) with (a + x * eval (b :: t) x).
    assert (m - a <= x * m).
    { apply (Rmult_le_compat_r m) in D; [|lra]. unfold Rdiv in D. rewrite Rmult_assoc, Rinv_l in D; lra. }
    nra.
Qed.
Lemma far_above_positive l c : last l 0 > 0 -> exists p, c < p /\ eval l p > 0.
Proof.
  intro H. destruct (far l H) as [X [m [M W]]]. exists (Rmax X (c + 1)).
  assert (A := Rmax_r X (c + 1)). specialize (W _ (Rmax_l X (c + 1))). split; lra.
Qed.
Lemma far_above_negative l c : last l 0 < 0 -> exists p, c < p /\ eval l p < 0.
Proof.
  intro H. destruct (far_above_positive (map Ropp l) c) as [p [A B]]; [rewrite last_opp; lra|].
  rewrite eval_opp in B. exists p. split; lra.
Qed.
Lemma far_below_positive l c : last (alternate l) 0 > 0 -> exists p, p < c /\ eval l p > 0.
Proof.
  intro H. destruct (far_above_positive (alternate l) (- c) H) as [p [A B]]. rewrite eval_alternate in B.
  exists (- p). split; lra.
Qed.
Lemma far_below_negative l c : last (alternate l) 0 < 0 -> exists p, p < c /\ eval l p < 0.
Proof.
  intro H. destruct (far_above_negative (alternate l) (- c) H) as [p [A B]]. rewrite eval_alternate in B.
  exists (- p). split; lra.
Qed.

Lemma divided l x : exists k, length k = pred (length l) /\ ((2 <= length l)%nat -> last k 0 = last l 0) /\
  forall z, eval l z - eval l x = (z - x) * eval k z.
Proof.
  induction l as [|a t [k [N [T E]]]]; [exists []; repeat split; simpl; try lia; intros; ring|].
  destruct t as [|b t]; [exists []; repeat split; simpl; try lia; intros; ring|].
  exists (eval (b :: t) x :: k). split; [|split].
  - simpl in *. lia.
  - intros _. destruct t as [|c t].
    + assert (K : k = []) by (destruct k; [reflexivity|discriminate]). subst k. simpl. ring.
    + destruct k as [|d k]; [discriminate|]. change (last (eval (b :: c :: t) x :: d :: k) 0) with (last (d :: k) 0).
      rewrite T by (simpl; lia). reflexivity.
  - intro z. change (eval (a :: b :: t) z) with (a + z * eval (b :: t) z).
    change (eval (a :: b :: t) x) with (a + x * eval (b :: t) x).
    change (eval (eval (b :: t) x :: k) z) with (eval (b :: t) x + z * eval k z).
    replace (a + z * eval (b :: t) z - (a + x * eval (b :: t) x))
      with (z * (eval (b :: t) z - eval (b :: t) x) + (z - x) * eval (b :: t) x) by ring.
    rewrite E. ring.
Qed.

Lemma no_other l rs y : NoDup rs -> length l = S (length rs) -> last l 0 <> 0 ->
  (forall x, In x rs -> eval l x = 0) -> eval l y = 0 -> In y rs.
Proof.
  revert l. induction rs as [|x t IH]; intros l D N T Z Y.
  - destruct l as [|a [|b l]]; try discriminate. simpl in *. exfalso. apply T. lra.
  - destruct (Req_dec x y) as [E|E]; [now left|]. right. inversion D as [|? ? Out D']; subst.
    destruct (divided l x) as [k [Nk [Tk Ek]]].
    assert (zero : forall z, z <> x -> eval l z = 0 -> eval k z = 0).
    { intros z Hz Vz. specialize (Ek z). rewrite Vz, (Z x (or_introl eq_refl)) in Ek.
      assert (W : (z - x) * eval k z = 0) by lra. apply Rmult_integral in W. destruct W; [exfalso; lra|assumption]. }
    apply (IH k); auto.
    + rewrite Nk, N. reflexivity.
    + rewrite Tk; [exact T|]. rewrite N. simpl. lia.
    + intros z Hz. apply zero; [|apply Z; now right]. intro F. subst z. now apply Out.
Qed.

Ltac distinct := repeat (apply NoDup_cons; [let F := fresh in simpl; intro F; repeat (destruct F as [F|F]) | ]); try apply NoDup_nil; try contradiction.
Ltac unfold_places := repeat match goal with p := _ : R |- _ => unfold p in *; clear p end.

(* ---- sums of polynomials in h, by the lists of their coefficients *)

Fixpoint padd (a b : list R) : list R :=
  match a, b with [], _ => b | _, [] => a | x :: s, y :: t => (x + y) :: padd s t end.
Lemma eval_padd a : forall b h, eval (padd a b) h = eval a h + eval b h.
Proof. induction a as [|x s IH]; intros [|y t] h; simpl; try ring. rewrite IH. ring. Qed.
Fixpoint pmul (a b : list R) : list R :=
  match a with [] => [] | x :: s => padd (map (Rmult x) b) (0 :: pmul s b) end.
Lemma eval_scaled x b h : eval (map (Rmult x) b) h = x * eval b h.
Proof. induction b as [|y t IH]; simpl; [ring|]. rewrite IH. ring. Qed.
Lemma eval_pmul a b h : eval (pmul a b) h = eval a h * eval b h.
Proof. induction a as [|x s IH]; simpl; [ring|]. rewrite eval_padd, eval_scaled. simpl. rewrite IH. ring. Qed.
Lemma eval_shifted N l h : eval (repeat 0 N ++ l) h = h ^ N * eval l h.
Proof. induction N as [|N IH]; simpl; [ring|]. rewrite IH. ring. Qed.

(* ---- polynomials: expressions whose normal forms Coq computes *)

Inductive expr := Num (z : Z) | Letter (n : nat) | Add (a b : expr) | Sub (a b : expr) | Mul (a b : expr) | Opp (a : expr)
  | Over (a : expr) (p : positive) | Pow (a : expr) (n : nat).
Declare Scope expr_scope.
Delimit Scope expr_scope with E.
Bind Scope expr_scope with expr.
Definition z_of (e : expr) : option Z := match e with Num z => Some z | _ => None end.
Number Notation expr Num z_of : expr_scope.
Notation "a + b" := (Add a b) : expr_scope.
Notation "a - b" := (Sub a b) : expr_scope.
Notation "a * b" := (Mul a b) : expr_scope.
Notation "- a" := (Opp a) : expr_scope.
Notation "a / p" := (Over a p%positive) : expr_scope.
Notation "a ^ n" := (Pow a n%nat) : expr_scope.

Fixpoint value (v : nat -> R) (e : expr) : R :=
  match e with
  | Num z => IZR z | Letter n => v n | Add a b => value v a + value v b | Sub a b => value v a - value v b
  | Mul a b => value v a * value v b | Opp a => - value v a | Over a p => value v a / IZR (Zpos p)
  | Pow a n => value v a ^ n
  end.

(* a polynomial is a list of exponents with coefficients, the exponents in order *)
Definition poly := list (list nat * Q).
Fixpoint product (v : nat -> R) (k : nat) (m : list nat) : R :=
  match m with [] => 1 | n :: t => v k ^ n * product v (S k) t end.
Fixpoint sum (v : nat -> R) (p : poly) : R :=
  match p with [] => 0 | (m, c) :: t => Q2R c * product v 0 m + sum v t end.

Fixpoint both (a b : list nat) : list nat :=
  match a, b with [], _ => b | _, [] => a | x :: s, y :: t => (x + y)%nat :: both s t end.
Fixpoint order (a b : list nat) : comparison :=
  match a, b with
  | [], [] => Eq | [], _ => Lt | _, [] => Gt
  | x :: s, y :: t => match Nat.compare x y with Eq => order s t | other => other end
  end.
Definition plus : poly -> poly -> poly := fix outer a := fix inner b :=
  match a, b with
  | [], _ => b | _, [] => a
  | (m, c) :: s, (n, d) :: t =>
      match order m n with
      | Lt => (m, c) :: outer s b | Gt => (n, d) :: inner t
      | Eq => let e := Qred (c + d) in if Qeq_bool e 0 then outer s t else (m, e) :: outer s t
      end
  end.
Definition scaled (f : list nat * Q) (p : poly) : poly := map (fun g => (both (fst f) (fst g), Qred (snd f * snd g))) p.
Definition times (a b : poly) : poly := fold_right (fun f rest => plus (scaled f b) rest) [] a.
Fixpoint power (a : poly) (n : nat) : poly := match n with O => [([], 1%Q)] | S k => times a (power a k) end.
Fixpoint variable (n : nat) : list nat := match n with O => [1%nat] | S k => 0%nat :: variable k end.
Fixpoint normal (e : expr) : poly :=
  match e with
  | Num z => if Z.eqb z 0 then [] else [([], z # 1)] | Letter n => [(variable n, 1%Q)] | Add a b => plus (normal a) (normal b)
  | Sub a b => plus (normal a) (scaled ([], -1 # 1) (normal b)) | Mul a b => times (normal a) (normal b)
  | Opp a => scaled ([], -1 # 1) (normal a) | Over a p => scaled ([], 1 # p) (normal a)
  | Pow a n => power (normal a) n
  end.

Lemma Q2R_red q : Q2R (Qred q) = Q2R q.
Proof. apply Qeq_eqR, Qred_correct. Qed.
Lemma product_both v a : forall b k, product v k (both a b) = product v k a * product v k b.
Proof. induction a as [|x s IH]; intros [|y t] k; simpl; try ring. rewrite IH, pow_add. ring. Qed.
Lemma order_same a : forall b, order a b = Eq -> a = b.
Proof.
  induction a as [|x s IH]; intros [|y t]; simpl; try discriminate; auto.
  destruct (Nat.compare x y) eqn:E; try discriminate. intro H. apply Nat.compare_eq in E. now rewrite E, (IH t H).
Qed.
Lemma plus_steps m c s n d t : plus ((m, c) :: s) ((n, d) :: t) =
  match order m n with
  | Lt => (m, c) :: plus s ((n, d) :: t) | Gt => (n, d) :: plus ((m, c) :: s) t
  | Eq => let e := Qred (c + d) in if Qeq_bool e 0 then plus s t else (m, e) :: plus s t
  end.
Proof. reflexivity. Qed.
Lemma plus_none a : plus a [] = a.
Proof. destruct a as [|[m c] s]; reflexivity. Qed.
Lemma sum_plus v a : forall b, sum v (plus a b) = sum v a + sum v b.
Proof.
  induction a as [|[m c] s IH]; [intros [|[n d] t]; simpl; ring|].
  induction b as [|[n d] t IHb]; [rewrite plus_none; simpl; ring|]. rewrite plus_steps. destruct (order m n) eqn:E.
  - apply order_same in E. subst n.
    assert (H : Q2R (Qred (c + d)) = Q2R c + Q2R d) by (rewrite Q2R_red; apply Q2R_plus).
    cbv zeta. destruct (Qeq_bool (Qred (c + d)) 0) eqn:Z.
    + apply Qeq_bool_eq, Qeq_eqR in Z. rewrite IH. cbn [sum].
      replace (Q2R d) with (- Q2R c) by (rewrite Z in H; unfold Q2R in H at 1; simpl in H; lra). ring.
    + cbn [sum]. rewrite IH, H. ring.
  - cbn [sum]. rewrite IH. cbn [sum]. ring.
  - cbn [sum]. rewrite IHb. cbn [sum]. ring.
Qed.
Lemma sum_scaled v f p : sum v (scaled f p) = Q2R (snd f) * product v 0 (fst f) * sum v p.
Proof.
  induction p as [|[m c] t IH]; [cbn [scaled map sum]; ring|]. cbn [scaled map sum fst snd]. fold (scaled f t).
  rewrite IH, Q2R_red, Q2R_mult, product_both. cbn [sum]. ring.
Qed.
Lemma sum_times v a b : sum v (times a b) = sum v a * sum v b.
Proof. induction a as [|[m c] t IH]; simpl; [ring|]. rewrite sum_plus, sum_scaled, IH. simpl. ring. Qed.
Lemma sum_power v a n : sum v (power a n) = sum v a ^ n.
Proof. induction n as [|n IH]; simpl; [unfold Q2R; simpl; field|]. now rewrite sum_times, IH. Qed.
Lemma product_variable v n : forall k, product v k (variable n) = v (k + n)%nat.
Proof.
  induction n as [|n IH]; intro k; simpl; [rewrite Nat.add_0_r; ring|].
  rewrite IH. replace (S k + n)%nat with (k + S n)%nat by lia. ring.
Qed.
Lemma Q2R_whole z : Q2R (z # 1) = IZR z.
Proof. unfold Q2R. simpl. field. Qed.
Lemma normal_is v e : value v e = sum v (normal e).
Proof.
  induction e; cbn [value normal].
  - destruct (Z.eqb_spec z 0) as [E|E]; [subst; reflexivity|]. cbn [sum product]. rewrite Q2R_whole. ring.
  - cbn [sum]. rewrite product_variable, Q2R_whole. simpl. ring.
  - rewrite sum_plus, IHe1, IHe2. reflexivity.
  - rewrite sum_plus, sum_scaled, IHe1, IHe2. cbn [fst snd product]. rewrite Q2R_whole. ring.
  - rewrite sum_times, IHe1, IHe2. reflexivity.
  - rewrite sum_scaled, IHe. cbn [fst snd product]. rewrite Q2R_whole. ring.
  - rewrite sum_scaled, IHe. cbn [fst snd product]. unfold Q2R, Rdiv. cbn [Qnum Qden]. ring.
  - rewrite sum_power, IHe. reflexivity.
Qed.

(* ---- equal expressions *)
Lemma same v a b : normal (a - b)%E = [] -> value v a = value v b.
Proof. intro H. assert (W := normal_is v (a - b)%E). rewrite H in W. cbn [value sum] in W. lra. Qed.

(* ---- their derivatives by a letter *)
Fixpoint slope (k : nat) (e : expr) : expr :=
  (match e with
  | Num _ => 0 | Letter n => if Nat.eqb n k then 1 else 0 | Add a b => slope k a + slope k b
  | Sub a b => slope k a - slope k b | Mul a b => slope k a * b + a * slope k b | Opp a => - slope k a
  | Over a p => slope k a / p | Pow a n => match n with O => 0 | S m => Num (Z.of_nat n) * a ^ m * slope k a end
  end)%E.
Definition letter_at (v : nat -> R) (k : nat) (x : R) (n : nat) : R := if Nat.eqb n k then x else v n.
Lemma derivative_is f x l k : derivable_pt_lim f x l -> l = k -> derivable_pt_lim f x k.
Proof. intros H E. now rewrite <- E. Qed.
Lemma slope_is v k e x : derivable_pt_lim (fun y => value (letter_at v k y) e) x (value (letter_at v k x) (slope k e)).
Proof.
  induction e as [z|n|a IHa b IHb|a IHa b IHb|a IHa b IHb|a IHa|a IHa p|a IHa n]; cbn [slope value].
  - apply derivable_pt_lim_const.
  - unfold letter_at at 1. destruct (Nat.eqb n k); [apply derivable_pt_lim_id|apply derivable_pt_lim_const].
  - now apply (derivable_pt_lim_plus (fun y => value (letter_at v k y) a) (fun y => value (letter_at v k y) b)).
  - now apply (derivable_pt_lim_minus (fun y => value (letter_at v k y) a) (fun y => value (letter_at v k y) b)).
  - now apply (derivable_pt_lim_mult (fun y => value (letter_at v k y) a) (fun y => value (letter_at v k y) b)).
  - now apply (derivable_pt_lim_opp (fun y => value (letter_at v k y) a)).
  - eapply derivative_is.
    + apply (derivable_pt_lim_mult (fun y => value (letter_at v k y) a) (fun _ => / IZR (Zpos p)));
        [apply IHa|apply derivable_pt_lim_const].
    + unfold Rdiv. ring.
  - eapply derivative_is.
    + apply (derivable_pt_lim_comp (fun y => value (letter_at v k y) a) (fun y => y ^ n));
        [apply IHa|apply derivable_pt_lim_pow].
    + destruct n as [|m]; cbn [value]; [simpl; ring|]. rewrite <- INR_IZR_INZ. cbn [pred]. ring.
Qed.
Lemma derivative v k e d x : normal (slope k e - d)%E = [] ->
  derivable_pt_lim (fun y => value (letter_at v k y) e) x (value (letter_at v k x) d).
Proof. intro H. rewrite <- (same _ (slope k e) d H). apply slope_is. Qed.

(* ---- expressions that vanish to an order: each variable stands with a power of h *)
Fixpoint weight (w m : list nat) : nat :=
  match m, w with [], _ => 0 | _, [] => 0 | n :: t, k :: u => k * n + weight u t end.
Definition moved (w : list nat) (l : list R) (h : R) (n : nat) : R := h ^ nth n w 0%nat * nth n l 0.

Lemma product_moved w l h m : forall k,
  product (fun n => h ^ nth (n - k) w 0%nat * nth n l 0) k m = h ^ weight w m * product (fun n => nth n l 0) k m.
Proof.
  revert w. induction m as [|n t IH]; intros w k; [destruct w; simpl; ring|]. cbn [product].
  replace (k - k)%nat with 0%nat by lia. destruct w as [|j u].
  - assert (F : forall s i, product (fun n => h ^ nth (n - k) (@nil nat) 0%nat * nth n l 0) i s = product (fun n => nth n l 0) i s).
    { induction s as [|x s IHs]; intro i; cbn [product]; [reflexivity|]. rewrite IHs.
      destruct (i - k)%nat; cbn [nth pow]; rewrite Rmult_1_l; reflexivity. }
    rewrite F. cbn [nth weight pow]. rewrite !Rmult_1_l. reflexivity.
  - cbn [nth weight]. rewrite Rpow_mult_distr, pow_add, <- pow_mult.
    assert (G : forall s i, (k < i)%nat -> product (fun n => h ^ nth (n - k) (j :: u) 0%nat * nth n l 0) i s
              = product (fun n => h ^ nth (n - S k) u 0%nat * nth n l 0) i s).
    { induction s as [|x s IHs]; intros i Hi; cbn [product]; [reflexivity|].
      rewrite IHs by lia. replace (i - k)%nat with (S (i - S k)) by lia. reflexivity. }
    rewrite G, IH by lia. ring.
Qed.
Lemma product_weight w l h m : product (moved w l h) 0 m = h ^ weight w m * product (fun n => nth n l 0) 0 m.
Proof.
  rewrite <- product_moved. unfold moved.
  assert (F : forall k, product (fun n => h ^ nth n w 0%nat * nth n l 0) k m
    = product (fun n => h ^ nth (n - 0) w 0%nat * nth n l 0) k m); [|apply F].
  induction m as [|x t IH]; intro k; cbn [product]; [reflexivity|]. now rewrite IH, Nat.sub_0_r.
Qed.
Lemma sum_moved w l p : exists q, forall h, sum (moved w l h) p = eval q h.
Proof.
  induction p as [|[m c] t [q IH]]; [exists []; reflexivity|].
  exists (padd (repeat 0 (weight w m) ++ [Q2R c * product (fun n => nth n l 0) 0 m]) q). intro h.
  cbn [sum]. rewrite IH, eval_padd, eval_shifted, product_weight. cbn [eval]. ring.
Qed.

(* what a sum has below the order N *)
Definition cut (N : nat) (w : list nat) (p : poly) : poly := filter (fun f => Nat.ltb (weight w (fst f)) N) p.
Lemma sum_cut N w l p :
  exists q, forall h, sum (moved w l h) p = sum (moved w l h) (cut N w p) + h ^ N * eval q h.
Proof.
  induction p as [|[m c] t [q IH]]; [exists []; intro; simpl; ring|]. cbn [cut filter fst].
  destruct (Nat.ltb_spec (weight w m) N) as [A|A].
  - exists q. intro h. cbn [sum]. rewrite IH. unfold cut. ring.
  - exists (padd (repeat 0 (weight w m - N) ++ [Q2R c * product (fun n => nth n l 0) 0 m]) q). intro h.
    cbn [sum]. rewrite IH, eval_padd, eval_shifted, product_weight.
    replace (weight w m) with (N + (weight w m - N))%nat at 1 by lia. rewrite pow_add. unfold cut. cbn [eval]. ring.
Qed.

Fixpoint power_below (N : nat) (w : list nat) (a : poly) (n : nat) : poly :=
  match n with O => [([], 1%Q)] | S k => cut N w (times a (power_below N w a k)) end.
Fixpoint below (N : nat) (w : list nat) (e : expr) : poly :=
  match e with
  | Num _ | Letter _ => normal e | Add a b => plus (below N w a) (below N w b)
  | Sub a b => plus (below N w a) (scaled ([], -1 # 1) (below N w b))
  | Mul a b => cut N w (times (below N w a) (below N w b))
  | Opp a => scaled ([], -1 # 1) (below N w a) | Over a p => scaled ([], 1 # p) (below N w a)
  | Pow a n => power_below N w (below N w a) n
  end.

(* f is p up to h^N *)
Definition agrees N w l (f : R -> R) (p : poly) :=
  exists q, forall h, f h = sum (moved w l h) p + h ^ N * eval q h.
Lemma agrees_times N w l f g a b :
  agrees N w l f a -> agrees N w l g b -> agrees N w l (fun h => f h * g h) (cut N w (times a b)).
Proof.
  intros [p F] [q G]. destruct (sum_cut N w l (times a b)) as [r C].
  destruct (sum_moved w l a) as [x A]. destruct (sum_moved w l b) as [y B].
  exists (padd r (padd (pmul x q) (padd (pmul p y) (repeat 0 N ++ pmul p q)))). intro h.
  rewrite F, G, !eval_padd, eval_shifted, !eval_pmul, <- A, <- B.
  replace (sum (moved w l h) (cut N w (times a b)))
    with (sum (moved w l h) a * sum (moved w l h) b - h ^ N * eval r h) by (rewrite <- sum_times, C; ring). ring.
Qed.
Lemma agrees_scaled N w l f a c :
  agrees N w l f a -> agrees N w l (fun h => Q2R c * f h) (scaled ([], c) a).
Proof.
  intros [p F]. exists (map (Rmult (Q2R c)) p). intro h. rewrite F, eval_scaled, sum_scaled. cbn [fst snd product]. ring.
Qed.
Lemma agrees_plus N w l f g a b :
  agrees N w l f a -> agrees N w l g b -> agrees N w l (fun h => f h + g h) (plus a b).
Proof. intros [p F] [q G]. exists (padd p q). intro h. rewrite F, G, eval_padd, sum_plus. ring. Qed.
Lemma agrees_like N w l f g a : (forall h, f h = g h) -> agrees N w l f a -> agrees N w l g a.
Proof. intros E [p F]. exists p. intro h. rewrite <- E. apply F. Qed.
Lemma below_is N w l e : agrees N w l (fun h => value (moved w l h) e) (below N w e).
Proof.
  induction e; cbn [below].
  - exists []. intro h. rewrite normal_is. cbn [eval]. ring.
  - exists []. intro h. rewrite normal_is. cbn [eval]. ring.
  - apply (agrees_plus N w l _ _ _ _ IHe1 IHe2).
  - apply (agrees_like N w l (fun h => value (moved w l h) e1 + Q2R (-1 # 1) * value (moved w l h) e2)).
    + intro h. rewrite Q2R_whole. cbn [value]. ring.
    + apply agrees_plus; [assumption|]. now apply agrees_scaled.
  - apply (agrees_times N w l _ _ _ _ IHe1 IHe2).
  - apply (agrees_like N w l (fun h => Q2R (-1 # 1) * value (moved w l h) e)); [|now apply agrees_scaled].
    intro h. rewrite Q2R_whole. cbn [value]. ring.
  - apply (agrees_like N w l (fun h => Q2R (1 # p) * value (moved w l h) e)); [|now apply agrees_scaled].
    intro h. unfold Q2R, Rdiv. cbn [value Qnum Qden]. unfold Rdiv. ring.
  - cbn [value]. induction n as [|n IHn]; cbn [power_below pow].
    + exists []. intro h. cbn [sum product eval]. rewrite Q2R_whole. ring.
    + apply (agrees_times N w l _ _ _ _ IHe IHn).
Qed.
Lemma to_order N w l e : below N w e = [] -> exists q, forall h, value (moved w l h) e = h ^ N * eval q h.
Proof.
  intro H. destruct (below_is N w l e) as [q E]. rewrite H in E. exists q. intro h. rewrite E. cbn [sum]. ring.
Qed.
